#include "cli/files/people_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/recording/dealt_colliders.hpp"
#include "traces/scenarios/body.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kAvatarFlag = "--avatar";

/// The flags that belong to a person, and where their values go.
struct PersonFlag {
  const char* name;
  std::string& (*value)(PersonChoice&);
};
constexpr std::array<PersonFlag, 5> kPersonFlags = {{
    {"--animation", [](PersonChoice& person) -> std::string& { return person.animation; }},
    {"--map", [](PersonChoice& person) -> std::string& { return person.map; }},
    {"--facing", [](PersonChoice& person) -> std::string& { return person.facing.axis; }},
    {"--at", [](PersonChoice& person) -> std::string& { return person.at; }},
    {"--name", [](PersonChoice& person) -> std::string& { return person.name; }},
}};

/// Gives each of several people a name of their own: the one asked for, otherwise the avatar's file name.
void name_people(std::vector<PersonChoice>& people) {
  std::set<std::string> taken;
  for (const PersonChoice& person : people)
    if (!person.name.empty() && !taken.insert(person.name).second)
      throw UsageError("--name", fmt::format("two people are called '{}'", person.name), "give each another name");
  if (people.size() == 1) return;
  for (PersonChoice& person : people) {
    if (!person.name.empty()) continue;
    const std::string stem = std::filesystem::path(person.avatar).stem().string();
    person.name = stem;
    for (int number = 2; !taken.insert(person.name).second; ++number) person.name = fmt::format("{} {}", stem, number);
  }
}

/// The box around a person when the scene begins, in metres from the scene's origin.
Box first_box(const Person& person) {
  Pose pose = looped_pose(person.scene.avatar, person.animation, 0);
  move_to(person.stance, person.scene.avatar, pose);
  std::vector<glm::dvec3> skin_m;
  skin_reference(person.scene.avatar, pose, glm::dvec3(0), skin_m);
  return box_around(skin_m);
}

double volume_of(const Box& box) {
  const glm::dvec3 sides = glm::max(box.extent(), glm::dvec3(0));
  return sides.x * sides.y * sides.z;
}

}  // namespace

void add_people_options(CLI::App& verb) {
  verb.add_option(
          "--at",
          "Where the person stands, in metres from --origin, and where they look: YAW in degrees, "
          "counter-clockwise from above, 0 (also without YAW) along +Z [default: 0,0,0 and as the avatar looks]")
      ->type_name("X,Y,Z[,YAW]");
  verb.add_option("--name", "The person's name [with several people: the avatar's file name]")->type_name("TEXT");
  CLI::Option* avatar = verb.get_option(kAvatarFlag);
  avatar->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  avatar->description(avatar->get_description() +
                      ". Repeat it for more people: --animation, --map, --facing, --at and --name belong to the latest "
                      "--avatar before them");
  for (const PersonFlag& flag : kPersonFlags)
    verb.get_option(flag.name)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

std::vector<PersonChoice> people_choices(const CLI::App& verb) {
  std::vector<PersonChoice> people(1);
  std::map<const CLI::Option*, std::size_t> seen;  // how many values of each flag
  std::set<std::string> given;                     // for the latest person
  for (const CLI::Option* option : verb.parse_order()) {
    const auto flag = std::ranges::find_if(
        kPersonFlags, [&](const PersonFlag& each) { return option == verb.get_option(each.name); });
    const bool is_avatar = option == verb.get_option(kAvatarFlag);
    if (!is_avatar && flag == kPersonFlags.end()) continue;
    const std::string& value = option->results().at(seen[option]++);
    const std::string name = is_avatar ? kAvatarFlag : flag->name;
    if (is_avatar && given.contains(name)) {
      people.emplace_back();
      given.clear();
    }
    if (!given.insert(name).second)
      throw UsageError(
          name, people.size() == 1 ? "is given twice" : fmt::format("is given twice for person {}", people.size()),
          "give it once for each --avatar, after it");
    (is_avatar ? people.back().avatar : flag->value(people.back())) = value;
  }
  if (people.size() > trace_format::kMostPeople)
    throw UsageError(kAvatarFlag, fmt::format("a trace cannot hold {} people", people.size()),
                     fmt::format("record at most {}", trace_format::kMostPeople));
  name_people(people);
  return people;
}

Stance stance_of(const PersonChoice& choice, const Avatar& avatar) {
  if (choice.at.empty()) return {};
  const std::vector<double> numbers = parse_numbers(choice.at);
  if (numbers.size() != 3 && numbers.size() != 4)
    throw UsageError("--at", fmt::format("'{}' is not X,Y,Z,YAW", choice.at),
                     "give three numbers in metres and an angle in degrees: 0,0,0.6,180");
  const glm::dvec3 position_m = on_grid({numbers[0], numbers[1], numbers[2]});
  const double yaw_deg = numbers.size() == 4 ? numbers[3] : 0;
  const Stance stance = vestige::stance_of(position_m, yaw_deg, avatar.facing.axis);
  if (const std::string root = unturnable_root(avatar); stance.is_turned() && !root.empty())
    throw UsageError("--at",
                     fmt::format("{} cannot be turned: its root node {} has a skewed matrix", choice.avatar, root),
                     "give the node a rotation and a scale in the modelling program");
  return stance;
}

std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const std::vector<Person>& people,
                                               std::uint64_t seed) {
  if (choice.colliders == kNoColliders) return no_colliders();
  if (choice.from_file() ||
      (people.size() == 1 && people.front().stance.position_m == glm::dvec3(0) && !people.front().stance.is_turned()))
    return make_colliders(choice, people.front().scene.avatar, people.front().animation, seed);
  std::vector<Hand> hands;
  const std::size_t count = choice.collider_count();
  for (std::size_t k = 0; k < people.size(); ++k) {
    SceneChoice of_person = choice;
    of_person.count = static_cast<std::uint32_t>((count + people.size() - 1 - k) / people.size());
    hands.push_back({*of_person.count == 0
                         ? no_colliders()
                         : make_colliders(of_person, people[k].scene.avatar, people[k].animation, seed + k),
                     people[k].stance});
  }
  return deal_colliders(std::move(hands));
}

void warn_of_overlap(const std::vector<Person>& people, Verbosity verbosity) {
  constexpr double kMuch = 0.5;
  if (people.size() < 2) return;
  std::vector<Box> boxes;
  boxes.reserve(people.size());
  for (const Person& person : people) boxes.push_back(first_box(person));
  for (std::size_t b = 1; b < boxes.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const Box common = {glm::max(boxes[a].low, boxes[b].low), glm::min(boxes[a].high, boxes[b].high)};
      if (volume_of(common) <= kMuch * std::min(volume_of(boxes[a]), volume_of(boxes[b]))) continue;
      warn(fmt::format("'{}' and '{}' stand within each other when the scene begins; place them with --at",
                       people[a].scene.name, people[b].scene.name),
           verbosity);
    }
}

}  // namespace vestige::cli
