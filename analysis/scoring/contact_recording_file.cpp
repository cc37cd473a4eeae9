#include "analysis/scoring/contact_recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s";
constexpr std::string_view kHeaderOfSpheres =
    "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s,depth_m";
constexpr std::string_view kNoContact = ",,,,,,,,,";
constexpr std::string_view kRemedy = "run 'vestige batch' again: it writes this file into contacts/";
constexpr std::size_t kFieldsOfContact = 9;
static_assert(kNoContact.size() == kFieldsOfContact);

/// Reads the fields after the time. Returns false for a frame without contacts.
bool take_contact(CsvLines& lines, ColliderShape shape, std::uint32_t& collider, Contact& contact) {
  std::string_view first;
  if (!lines.take_text(first)) throw lines.error("is not a row of contacts");
  if (first.empty()) {
    for (std::size_t i = 1; i < kFieldsOfContact + (shape == ColliderShape::kSpheres ? 1 : 0); ++i)
      if (std::string_view field; !lines.take_text(field) || !field.empty())
        throw lines.error("has only some of the fields of a contact");
    return false;
  }
  const auto [end, failure] = std::from_chars(first.data(), first.data() + first.size(), collider);
  int side = 0;
  if (failure != std::errc() || end != first.data() + first.size() || !lines.take(contact.triangle) ||
      !lines.take(contact.t) || !lines.take(contact.barycentric.x) || !lines.take(contact.barycentric.y) ||
      !lines.take(contact.texture_coordinate.x) || !lines.take(contact.texture_coordinate.y) || !lines.take(side) ||
      !lines.take(contact.speed_m_per_s) ||
      (shape == ColliderShape::kSpheres && !(lines.take(contact.depth_m) && contact.depth_m >= 0)) || side < -1 ||
      side > 1 || !contact.hit())
    throw lines.error("is not a row of contacts");
  contact.side = static_cast<std::int8_t>(side);
  return true;
}

}  // namespace

void write_contact_recording(const std::string& path, const RecordedTrace& trace) {
  const ContactRecording& recording = trace.contacts;
  OutputFile file(path, Overwrite::kAllow);
  const bool has_depths = trace.shape == ColliderShape::kSpheres;
  std::string text = fmt::format("{}\n", has_depths ? kHeaderOfSpheres : kHeader);
  const auto out = std::back_inserter(text);
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) {
    const double time_s = recording.time_s[frame];
    if (recording.first[frame] == recording.first[frame + 1])
      fmt::format_to(out, "{},{}{}{}\n", frame, time_s, kNoContact, has_depths ? "," : "");
    for (std::size_t i = recording.first[frame]; i < recording.first[frame + 1]; ++i) {
      const Contact& contact = recording.contacts[i];
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{}", frame, time_s, trace.collider_ids[recording.column[i]],
                     contact.triangle, contact.t, contact.barycentric.x, contact.barycentric.y,
                     contact.texture_coordinate.x, contact.texture_coordinate.y, contact.side, contact.speed_m_per_s);
      if (has_depths) fmt::format_to(out, ",{}", contact.depth_m);
      text += '\n';
    }
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.commit();
}

RecordedTrace read_contact_recording(const std::string& path) {
  const std::string text = read_text_file(path);
  RecordedTrace trace;
  if (CsvLines::has_header(text, kHeaderOfSpheres)) trace.shape = ColliderShape::kSpheres;
  CsvLines lines(text, path, trace.shape == ColliderShape::kSpheres ? kHeaderOfSpheres : kHeader, kRemedy);
  ContactRecording& recording = trace.contacts;
  std::vector<std::uint32_t> colliders;  // of each contact
  recording.first.push_back(0);
  while (lines.next()) {
    std::size_t frame = 0;
    double time_s = 0;
    if (!lines.take(frame) || !lines.take(time_s)) throw lines.error("is not a row of contacts");
    const bool same_frame = recording.frames() != 0 && frame + 1 == recording.frames();
    if (!same_frame && frame != recording.frames())
      throw lines.error("skips a frame, or goes back to an earlier frame");
    if (same_frame ? time_s != recording.time_s.back() : frame != 0 && !(time_s >= recording.time_s.back()))
      throw lines.error("has a time that does not fit its frame");
    std::uint32_t collider = 0;
    Contact contact;
    const bool hit = take_contact(lines, trace.shape, collider, contact);
    if (!lines.at_end()) throw lines.error("has too many fields");
    if (!same_frame) {
      recording.time_s.push_back(time_s);
      recording.first.push_back(colliders.size());
    } else if (!hit || recording.first[frame] == colliders.size() || colliders.back() >= collider) {
      throw lines.error("must have a greater collider than the row before");
    }
    if (!hit) continue;
    colliders.push_back(collider);
    recording.contacts.push_back(contact);
    recording.first.back() = colliders.size();
  }
  trace.collider_ids = colliders;
  auto& ids = trace.collider_ids;
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());  // clang 14 does not take std::ranges::unique
  for (const std::uint32_t collider : colliders)
    recording.column.push_back(static_cast<std::uint32_t>(std::ranges::lower_bound(trace.collider_ids, collider) -
                                                          trace.collider_ids.begin()));
  return trace;
}

}  // namespace vestige
