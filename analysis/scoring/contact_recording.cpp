#include "analysis/scoring/contact_recording.hpp"

namespace vestige {

void ContactRecording::add(double frame_time_s, std::span<const Contact> row) {
  if (first.empty()) first.push_back(0);
  time_s.push_back(frame_time_s);
  for (std::uint32_t i = 0; i < row.size(); ++i) {
    if (!row[i].hit()) continue;
    column.push_back(i);
    contacts.push_back(row[i]);
  }
  first.push_back(contacts.size());
}

}  // namespace vestige
