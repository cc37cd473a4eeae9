#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/view/collider_tracks.hpp"
#include "analysis/view/page_data.hpp"
#include "analysis/view/pose_keys.hpp"
#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// A person of a page, as one detector and one map see them. A page with two sides has each person twice.
struct PagePerson {
  std::string name;  ///< empty: the trace names nobody
  const Avatar& avatar;
  const ActuatorMap& map;
  std::size_t body = 0;  ///< the person of the trace, counted from 0
  std::size_t side = 0;  ///< counted from 0
};

/// Contacts of one collider on the two sides of a page are the same if no more time lies between them: a little more
/// than a frame at 30 Hz. A page may have another limit in its head.
inline constexpr double kSameContact_s = 0.035;

/// What a page carries.
struct PageContent {
  nlohmann::ordered_json head;
  std::string data;  ///< `PageArrays::packed`

  /// Adds a sentence to those that stand on top of the page.
  void warn(std::string sentence) { head["warnings"].push_back(std::move(sentence)); }
};

/// Packs a trace with its contacts and duties for a page. Poses and colliders are thinned for the eye (`PoseKeys`,
/// `ColliderTracks`). Contacts and duties are kept exactly.
class PagePacker {
 public:
  /// Keeps references to avatars and maps. `people`: first all of the first side. `sides`: what their titles are; none
  /// if there is one side. `collider_ids`: all of the trace, ascending.
  PagePacker(std::span<const PagePerson> people, std::vector<std::string> sides,
             std::span<const std::uint32_t> collider_ids);

  /// Takes the next frame of the trace.
  void add(const TraceFrame& frame);
  /// Takes what was found on a person, by the place in `people`, in the frame taken last. The row must carry triangle,
  /// t, barycentric, position and side. Returns how many contacts these are.
  std::size_t add_contacts(std::size_t person, const DetectorFrame& frame, const ContactRow& row);
  /// Takes the duties of a person in the frame taken last.
  void add_duties(std::size_t person, const ActuatorFrame& felt);

  /// Returns head and data. The head has people, arrays, how exact the picture is, and warnings about what is not
  /// drawn.
  PageContent finish();

 private:
  struct Contacts {
    std::vector<std::uint32_t> row, collider, triangle;
    std::vector<float> t;
    std::vector<double> barycentric, position_m;
    std::vector<std::uint16_t> actuator;
    std::vector<std::int8_t> side;
  };
  struct Duties {
    std::vector<std::uint8_t> last;
    std::vector<std::uint32_t> row;
    std::vector<std::uint16_t> actuator;
    std::vector<std::uint8_t> duty;
  };
  struct Person {
    PagePerson who;
    Contacts contacts = {};
    Duties duties = {};
  };

  void find_origin(const TraceFrame& frame);
  nlohmann::ordered_json finish_body(std::size_t body);
  nlohmann::ordered_json finish_person(const Person& person, const std::string& prefix);

  std::vector<Person> people_;
  std::vector<std::string> sides_;
  std::vector<PoseKeys> poses_;  ///< of each body
  ColliderTracks colliders_;
  bool has_origin_ = false;
  glm::dvec3 origin_m_ = glm::dvec3(0);
  std::vector<std::uint32_t> frame_index_;
  std::vector<double> time_ns_;
  PageArrays arrays_;
};

}  // namespace vestige
