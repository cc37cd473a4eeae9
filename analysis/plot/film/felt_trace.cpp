#include "analysis/plot/film/felt_trace.hpp"

#include "analysis/plot/studio/subject_run.hpp"

namespace vestige::plot {

FeltTrace::FeltTrace(TraceReader& trace, const std::vector<Subject>& people, const LawFlags& law, Method method)
    : trace_(trace),
      ids_(trace.collider_ids()),
      run_(make_run(people, ids_, law, method, kHashedPlanes | Plane::kBarycentric)) {
  rewind();
}

void FeltTrace::rewind() {
  trace_.rewind();
  run_.rewind();
}

bool FeltTrace::next() {
  if (!trace_.next(frame_)) return false;
  run_.step(frame_);
  contacts_.clear();
  duty_.clear();
  for (std::size_t i = 0; i < run_.seen().size(); ++i) {
    const SeenPerson& seen = run_.seen()[i];
    note_contacts(i, seen.row);
    if (seen.felt != nullptr) duty_.insert(duty_.end(), seen.felt->duty.begin(), seen.felt->duty.end());
  }
  return true;
}

std::vector<std::string> FeltTrace::notes() const {
  return notes_of(run_, trace_.people().size());
}

void FeltTrace::note_contacts(std::size_t person, const ContactRow& row) {
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& found = row[column];
    if (!found.hit()) continue;
    RecordedContact& contact = contacts_.emplace_back();
    contact.frame = frame_.index;
    contact.time_s = frame_.time_s();
    contact.collider = ids_[column];
    contact.triangle = found.triangle;
    contact.barycentric = found.barycentric;
    contact.actuator = found.actuator;
    contact.avatar = static_cast<std::uint16_t>(person + 1);
  }
}

}  // namespace vestige::plot
