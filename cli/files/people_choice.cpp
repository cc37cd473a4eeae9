#include "cli/files/people_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/places/body.hpp"
#include "traces/recording/dealt_colliders.hpp"
#include "traces/scenarios/touch.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kAvatarFlag = "--avatar";

/// The flags that belong to a person, and where their values go.
struct PersonSetting {
  const char* name;
  std::string& (*value)(PersonChoice&);
};
constexpr std::array<PersonSetting, 7> kPersonSettings = {{
    {"--animation", [](PersonChoice& person) -> std::string& { return person.animation; }},
    {"--map", [](PersonChoice& person) -> std::string& { return person.map; }},
    {"--facing", [](PersonChoice& person) -> std::string& { return person.facing.axis; }},
    {"--at", [](PersonChoice& person) -> std::string& { return person.at; }},
    {"--limbs", [](PersonChoice& person) -> std::string& { return person.limbs; }},
    {"--name", [](PersonChoice& person) -> std::string& { return person.name; }},
    {"--live", [](PersonChoice& person) -> std::string& { return person.live; }},
}};

/// The people of --colliders touch.
std::vector<PersonChoice> people_who_touch(const CLI::App& verb) {
  for (const char* flag : {kAvatarFlag, "--animation", "--facing", "--at", "--limbs", "--name", "--count", "--radius"})
    if (verb.count(flag) != 0)
      throw UsageError(flag, "--colliders touch brings its own people, who move by themselves",
                       fmt::format("leave {} out; to put people of your own together, write --avatar A --limbs "
                                   "hand_right --avatar B --at X,Y,Z,YAW",
                                   flag));
  std::vector<PersonChoice> people(2);
  people[0].name = "giver";
  people[0].limbs = "hand_right";
  people[1].name = "receiver";
  for (PersonChoice& person : people) person.map = verb.get_option("--map")->as<std::string>();
  return people;
}

/// Gives each of several people a name of their own: the one asked for, otherwise the avatar's file name.
void name_people(std::vector<PersonChoice>& people) {
  std::set<std::string> taken;
  for (const PersonChoice& person : people)
    if (const std::string fault = name_fault(person.name); !fault.empty())
      throw UsageError("--name", fault, "give a short name in one line");
  for (const PersonChoice& person : people)
    if (!person.name.empty() && !taken.insert(person.name).second)
      throw UsageError("--name", fmt::format("two people are called '{}'", person.name), "give each another name");
  if (people.size() == 1) return;
  for (PersonChoice& person : people) {
    if (!person.name.empty()) continue;
    const std::string stem = readable_name(std::filesystem::path(person.avatar).stem().string());
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
  const std::string limbs_help = fmt::format(
      "Limbs of the person that become colliders for the others, as spheres of their size: all, or any of {}. Then "
      "--colliders is none by default",
      fmt::join(limb_names(), ", "));
  verb.add_option("--limbs", limbs_help)->type_name("all|LIST");
  verb.add_option("--name", "The person's name [with several people: the avatar's file name]")->type_name("TEXT");
  CLI::Option* avatar = verb.get_option(kAvatarFlag);
  avatar->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  avatar->description(
      avatar->get_description() +
      ". Repeat it for more people: --animation, --map, --facing, --at, --limbs, --name and --live belong to "
      "the latest --avatar before them");
  for (const PersonSetting& flag : kPersonSettings)
    verb.get_option(flag.name)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

std::vector<PersonChoice> people_choices(const CLI::App& verb) {
  if (verb.get_option("--colliders")->as<std::string>() == kTouch) return people_who_touch(verb);
  std::vector<PersonChoice> people(1);
  std::map<const CLI::Option*, std::size_t> seen;  // how many values of each flag
  std::set<std::string> given;                     // for the latest person
  for (const CLI::Option* option : verb.parse_order()) {
    const auto flag = std::ranges::find_if(
        kPersonSettings, [&](const PersonSetting& each) { return option == verb.get_option(each.name); });
    const bool is_avatar = option == verb.get_option(kAvatarFlag);
    if (!is_avatar && flag == kPersonSettings.end()) continue;
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

void let_touch(std::vector<Person>& people) {
  Avatar& giver = people[0].scene.avatar;
  const Avatar& receiver = people[1].scene.avatar;
  const TouchStances stances = touch_stances(giver, receiver);
  giver.animations.push_back(pat_on_shoulder(giver, receiver, stances));
  people[0].animation = &giver.animations.back();
  people[1].animation = idle_of(receiver);
  people[0].stance = stances.giver;
  people[1].stance = stances.receiver;
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
  SceneChoice of_person = choice;
  of_person.people = people.size();
  if (choice.from_file() ||
      (people.size() == 1 && people.front().stance.position_m == glm::dvec3(0) && !people.front().stance.is_turned()))
    return make_colliders(of_person, people.front().scene.avatar, people.front().animation, seed);
  std::vector<Hand> hands;
  const std::size_t count = choice.collider_count();
  for (std::size_t k = 0; k < people.size(); ++k) {
    of_person.count = static_cast<std::uint32_t>((count + people.size() - 1 - k) / people.size());
    hands.push_back({*of_person.count == 0
                         ? no_colliders()
                         : make_colliders(of_person, people[k].scene.avatar, people[k].animation, seed + k),
                     people[k].stance});
  }
  return deal_colliders(std::move(hands));
}

namespace {

std::vector<LimbSphere> spheres_of(const std::string& text, const std::string& name, const Avatar& avatar) {
  const std::vector<std::string>& known = limb_names();
  const bool wants_all = text == "all";
  std::map<std::string, std::vector<LimbSphere>> fitted;
  std::vector<std::string> told;
  for (const std::string& limb : known) {
    fitted[limb] = fit_limb(avatar, limb);
    if (!fitted[limb].empty()) told.push_back(limb);
  }
  if (told.empty())
    throw UsageError("--limbs", fmt::format("the joints of {} do not tell its limbs", name),
                     "rename its joints, or use an avatar whose joints have the names of a known program");
  std::vector<LimbSphere> spheres;
  std::set<std::string> taken;
  for (const std::string& limb : wants_all ? told : parse_list(text)) {
    if (std::ranges::find(known, limb) == known.end())
      throw UsageError("--limbs", fmt::format("there is no limb '{}'", limb),
                       fmt::format("write all, or choose from {}", fmt::join(known, ", ")));
    if (!taken.insert(limb).second)
      throw UsageError("--limbs", fmt::format("'{}' stands there twice", limb), "leave one of them out");
    const std::vector<LimbSphere>& of_limb = fitted[limb];
    if (of_limb.empty())
      throw UsageError("--limbs", fmt::format("the joints of {} do not tell its {}", name, limb),
                       fmt::format("choose from {}", fmt::join(told, ", ")));
    spheres.insert(spheres.end(), of_limb.begin(), of_limb.end());
  }
  return spheres;
}

}  // namespace

std::uint64_t first_limb_id(const SceneChoice& scene, const ColliderSource& source, std::size_t people) {
  if (const auto largest = source.largest_id()) return std::uint64_t{*largest} + 1;
  if (scene.colliders == kNoColliders) return 0;
  // Dealt to people, ids have gaps where one of them has a collider less.
  return (scene.collider_count() + people - 1) / people * people;
}

CarriedLimbs limbs_of(const std::vector<PersonChoice>& choices, const std::vector<Person>& people,
                      std::uint64_t first_id) {
  std::vector<std::vector<LimbSphere>> spheres;
  std::uint64_t end_id = first_id;
  for (std::size_t k = 0; k < people.size(); ++k) {
    spheres.push_back(choices[k].limbs.empty()
                          ? std::vector<LimbSphere>()
                          : spheres_of(choices[k].limbs, choices[k].avatar, people[k].scene.avatar));
    end_id += spheres.back().size();
  }
  if (end_id > std::numeric_limits<std::uint32_t>::max())
    throw Error("--limbs", fmt::format("their ids would follow {}, the largest of the colliders", first_id - 1),
                "give those colliders smaller ids");
  CarriedLimbs limbs(static_cast<std::uint32_t>(first_id));
  for (std::size_t k = 0; k < people.size(); ++k)
    if (!spheres[k].empty()) limbs.add(k, people[k].scene.avatar, spheres[k]);
  return limbs;
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
