#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
#include "traces/recording/carried_limbs.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/stance.hpp"

namespace vestige::cli {

/// What the flags say of one person of a recording.
struct PersonChoice {
  std::string avatar = "builtin";
  std::string animation;
  std::string map;
  FacingChoice facing;
  std::string at;     ///< X,Y,Z[,YAW]; empty: where the scene stands, as the avatar looks
  std::string limbs;  ///< "all", or a list of `limb_names`; empty: none
  std::string name;   ///< empty: made from the avatar's name where there are several people
  std::string live;   ///< where the motion comes from: "-", or vmc://HOST:PORT; empty: nothing is live
};

/// The value of --colliders that means two people of whom one touches the other.
inline constexpr const char* kTouch = "touch";

/// Adds --at, --limbs and --name, and lets --avatar, --animation, --map and --facing (`add_scene_options`) be given for
/// several people.
void add_people_options(CLI::App& verb);

/// Returns the people that the flags of `verb` describe, at least one; with --colliders touch its own two. --animation,
/// --map, --facing, --at, --limbs, --name and --live belong to the latest --avatar before them; before any, to the
/// first. Throws `UsageError` if a flag is given twice for a person, two people have one name, or there are too many
/// people.
std::vector<PersonChoice> people_choices(const CLI::App& verb);

/// A person who is ready to be recorded.
struct Person {
  Scene scene;
  const Animation* animation = nullptr;  ///< of the scene's avatar
  Stance stance;

  SampledPerson sampled() const { return {scene.avatar, animation, stance}; }
};

/// Places the two people of --colliders touch, and gives them their motions.
void let_touch(std::vector<Person>& people);

/// Returns where a person stands. Throws `UsageError` if --at is not understood, or the avatar cannot be turned.
Stance stance_of(const PersonChoice& choice, const Avatar& avatar);

/// Makes the colliders of a recording: of a scenario, those of one person, or of several dealt to them in turn; of a
/// file, those of the scene.
std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const std::vector<Person>& people,
                                               std::uint64_t seed);

/// Returns the id that follows the colliders of `source`.
std::uint64_t first_limb_id(const SceneChoice& scene, const ColliderSource& source, std::size_t people);

/// Returns the limbs that people carry as colliders, with ids from `first_id` on. Throws `UsageError` for a limb that
/// does not exist or that the joints of an avatar do not tell.
CarriedLimbs limbs_of(const std::vector<PersonChoice>& choices, const std::vector<Person>& people,
                      std::uint64_t first_id);

/// Warns if two people stand within each other when the scene begins.
void warn_of_overlap(const std::vector<Person>& people, Verbosity verbosity);

}  // namespace vestige::cli
