#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/plot/studio/subject.hpp"
#include "analysis/run/seen_run.hpp"
#include "detector/actuators/law_maker.hpp"
#include "detector/method.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// A trace frame by frame, with what its people feel: the CPU detector finds contacts, and a law makes duties of them.
class FeltTrace {
 public:
  /// Keeps references to the trace and its people. Throws `Error` or `UsageError` if the law cannot be used.
  FeltTrace(TraceReader& trace, const std::vector<Subject>& people, const LawFlags& law, Method method);

  /// Begins again with the first frame.
  void rewind();
  /// Goes to the next frame. Returns false at the end.
  bool next();

  const TraceFrame& frame() const { return frame_; }
  /// Returns the contacts of this frame: frame, time, collider, triangle, barycentric, actuator and person.
  const std::vector<RecordedContact>& contacts() const { return contacts_; }
  /// Returns the duties of all actuators, 0 … 255: the first person's, then the second's, and so on.
  const std::vector<std::uint8_t>& duty() const { return duty_; }
  /// Says what was not finite in the frames so far, and of which person, a sentence for each.
  std::vector<std::string> notes() const;

 private:
  void note_contacts(std::size_t person, const ContactRow& row);

  TraceReader& trace_;
  std::vector<std::uint32_t> ids_;
  SeenRun run_;
  TraceFrame frame_;
  std::vector<RecordedContact> contacts_;
  std::vector<std::uint8_t> duty_;
};

}  // namespace vestige::plot
