#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/plot/studio/subject.hpp"
#include "analysis/run/seen_run.hpp"
#include "detector/actuators/law_maker.hpp"
#include "detector/method.hpp"

namespace vestige::plot {

/// Makes the run of these people through a trace, with the CPU detector. Keeps references to them. `collider_ids` and
/// `planes` as in `SeenRun`.
SeenRun make_run(std::span<const Subject> people, std::span<const std::uint32_t> collider_ids, const LawFlags& law,
                 Method method, PlaneSet planes);

/// Says what was not finite in the frames so far, and of which of so many `people`, a sentence for each.
std::vector<std::string> notes_of(const SeenRun& run, std::size_t people);

}  // namespace vestige::plot
