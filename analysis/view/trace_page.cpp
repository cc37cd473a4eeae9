#include "analysis/view/trace_page.hpp"

namespace vestige {

void pack_frame(const TraceFrame& frame, std::span<SeenRun* const> sides, PagePacker& packer,
                std::span<std::uint64_t> contacts) {
  packer.add(frame);
  std::size_t person = 0;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    sides[side]->step(frame);
    for (const SeenPerson& seen : sides[side]->seen()) {
      contacts[side] += packer.add_contacts(person, seen.frame, seen.row);
      if (seen.felt != nullptr) packer.add_duties(person, *seen.felt);
      ++person;
    }
  }
}

std::optional<std::vector<std::uint64_t>> pack_trace(TraceReader& trace, std::span<SeenRun* const> sides,
                                                     PagePacker& packer, const std::function<bool(double)>& progress) {
  std::vector<std::uint64_t> contacts(sides.size());
  const auto total = static_cast<double>(trace.frame_count());
  double done = 0;
  TraceFrame frame;
  while (trace.next(frame)) {
    pack_frame(frame, sides, packer, contacts);
    if (!progress(++done / total)) return {};
  }
  return contacts;
}

}  // namespace vestige
