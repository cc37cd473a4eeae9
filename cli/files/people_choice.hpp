#pragma once

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
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
  std::string at;    ///< X,Y,Z[,YAW]; empty: where the scene stands, as the avatar looks
  std::string name;  ///< empty: made from the avatar's name where there are several people
};

/// Adds --at and --name, and lets --avatar, --animation, --map and --facing (`add_scene_options`) be given for several
/// people.
void add_people_options(CLI::App& verb);

/// Returns the people that the flags of `verb` describe, at least one. --animation, --map, --facing, --at and --name
/// belong to the latest --avatar before them; before any, to the first. Throws `UsageError` if a flag is given twice
/// for a person, two people have one name, or there are too many people.
std::vector<PersonChoice> people_choices(const CLI::App& verb);

/// A person who is ready to be recorded.
struct Person {
  Scene scene;
  const Animation* animation = nullptr;  ///< of the scene's avatar
  Stance stance;

  SampledPerson sampled() const { return {scene.avatar, animation, stance}; }
};

/// Returns where a person stands. Throws `UsageError` if --at is not understood, or the avatar cannot be turned.
Stance stance_of(const PersonChoice& choice, const Avatar& avatar);

/// Makes the colliders of a recording: of a scenario, those of one person, or of several dealt to them in turn; of a
/// file, those of the scene.
std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const std::vector<Person>& people,
                                               std::uint64_t seed);

/// Warns if two people stand within each other when the scene begins.
void warn_of_overlap(const std::vector<Person>& people, Verbosity verbosity);

}  // namespace vestige::cli
