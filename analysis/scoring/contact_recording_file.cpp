#include "analysis/scoring/contact_recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s";
constexpr std::string_view kHeaderOfSpheres =
    "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s,depth_m";
constexpr std::string_view kHeaderOfCovered =
    "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s,depth_m,covered";
constexpr std::string_view kRemedy = "run 'vestige batch' again: it writes this file into contacts/";
constexpr std::size_t kFieldsOfContact = 9;

/// What a file has beside the fields that all have.
struct Columns {
  bool depth = false;
  bool covered = false;

  std::size_t count() const { return kFieldsOfContact + (depth ? 1 : 0) + (covered ? 1 : 0); }
  std::string_view header() const {
    if (covered) return kHeaderOfCovered;
    return depth ? kHeaderOfSpheres : kHeader;
  }
};

Columns columns_of(std::string_view text) {
  const bool covered = CsvLines::has_header(text, kHeaderOfCovered);
  return {covered || CsvLines::has_header(text, kHeaderOfSpheres), covered};
}

/// Reads MAP:ACTUATOR:DEPTH of every place that the next contact of all maps covers. Returns false for other text.
bool take_covered(CsvLines& lines, std::size_t contacts_before, std::map<std::string, CoveredPlaces>& covered) {
  std::string_view rest;
  if (!lines.take_text(rest)) return false;
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    const std::size_t after_actuator = one.rfind(':');
    if (after_actuator == std::string_view::npos || after_actuator == 0) return false;
    const std::size_t after_map = one.rfind(':', after_actuator - 1);
    if (after_map == std::string_view::npos) return false;
    const auto read = [&](std::size_t from, std::size_t to, auto& value) {
      const auto [end, failure] = std::from_chars(one.data() + from, one.data() + to, value);
      return failure == std::errc() && end == one.data() + to;
    };
    CoveredPlace place;
    if (!read(after_map + 1, after_actuator, place.actuator) || place.actuator == 0 ||
        !read(after_actuator + 1, one.size(), place.depth_m) || !(place.depth_m > 0 && std::isfinite(place.depth_m)))
      return false;
    --place.actuator;
    CoveredPlaces& of_map = covered[std::string(one.substr(0, after_map))];
    of_map.first.resize(contacts_before + 1, of_map.places.size());
    of_map.places.push_back(place);
  }
  return true;
}

void add_covered(const std::map<std::string, CoveredPlaces>& covered, std::size_t contact, std::string& text) {
  std::string_view between;
  for (const auto& [map, places] : covered)
    for (const CoveredPlace& place : places.of(contact))
      fmt::format_to(std::back_inserter(text), "{}{}:{}:{}", std::exchange(between, " "), map, place.actuator + 1,
                     place.depth_m);
}

/// Reads the fields after the time, but for what is covered. Returns false for a frame without contacts.
bool take_contact(CsvLines& lines, const Columns& columns, std::uint32_t& collider, Contact& contact) {
  std::string_view first;
  if (!lines.take_text(first)) throw lines.error("is not a row of contacts");
  if (first.empty()) {
    for (std::size_t i = 1; i < columns.count(); ++i)
      if (std::string_view field; !lines.take_text(field) || !field.empty())
        throw lines.error("has only some of the fields of a contact");
    return false;
  }
  const auto [end, failure] = std::from_chars(first.data(), first.data() + first.size(), collider);
  int side = 0;
  if (failure != std::errc() || end != first.data() + first.size() || !lines.take(contact.triangle) ||
      !lines.take(contact.t) || !lines.take(contact.barycentric.x) || !lines.take(contact.barycentric.y) ||
      !lines.take(contact.texture_coordinate.x) || !lines.take(contact.texture_coordinate.y) || !lines.take(side) ||
      !lines.take(contact.speed_m_per_s) || (columns.depth && !(lines.take(contact.depth_m) && contact.depth_m >= 0)) ||
      side < -1 || side > 1 || !contact.hit())
    throw lines.error("is not a row of contacts");
  contact.side = static_cast<std::int8_t>(side);
  return true;
}

}  // namespace

void write_contact_recording(const std::string& path, const RecordedTrace& trace) {
  const ContactRecording& recording = trace.contacts;
  OutputFile file(path, Overwrite::kAllow);
  const bool has_covered = !trace.covered.empty();
  const Columns columns = {has_covered || trace.shape == ColliderShape::kSpheres, has_covered};
  std::string text = fmt::format("{}\n", columns.header());
  const auto out = std::back_inserter(text);
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) {
    const double time_s = recording.time_s[frame];
    if (recording.first[frame] == recording.first[frame + 1])
      fmt::format_to(out, "{},{}{:,<{}}\n", frame, time_s, "", columns.count());
    for (std::size_t i = recording.first[frame]; i < recording.first[frame + 1]; ++i) {
      const Contact& contact = recording.contacts[i];
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{}", frame, time_s, trace.collider_ids[recording.column[i]],
                     contact.triangle, contact.t, contact.barycentric.x, contact.barycentric.y,
                     contact.texture_coordinate.x, contact.texture_coordinate.y, contact.side, contact.speed_m_per_s);
      if (columns.depth) fmt::format_to(out, ",{}", contact.depth_m);
      if (columns.covered) {
        text += ',';
        add_covered(trace.covered, i, text);
      }
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
  const Columns columns = columns_of(text);
  if (columns.depth) trace.shape = ColliderShape::kSpheres;
  CsvLines lines(text, path, columns.header(), kRemedy);
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
    const bool hit = take_contact(lines, columns, collider, contact);
    if (hit && columns.covered && !take_covered(lines, colliders.size(), trace.covered))
      throw lines.error("has no list of MAP:ACTUATOR:DEPTH under 'covered'");
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
  for (auto& [map, places] : trace.covered) places.first.resize(colliders.size() + 1, places.places.size());
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
