#include "tests/support/pairs/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "analysis/base/clocks.hpp"
#include "detector/decide/start_distance.hpp"
#include "detector/decision.hpp"
#include "detector/truth/truth.hpp"
#include "tests/support/pairs/contact_cases.hpp"
#include "traces/scene/radius.hpp"

namespace vestige::test {

namespace {

constexpr std::size_t kMostExamples = 5;

std::string text_of(const glm::dvec3& x) {
  return fmt::format("{{{:a}, {:a}, {:a}}}", x.x, x.y, x.z);
}
std::string text_of(const Corners& triangle) {
  return fmt::format("{{{}, {}, {}}}", text_of(triangle.a), text_of(triangle.b), text_of(triangle.c));
}
std::string text_of(const std::optional<FirstTouch>& touch) {
  return touch ? fmt::format("t = {:a} side {}{}", touch->t, int{touch->side}, touch->at_start ? " at start" : "")
               : "no touch";
}
std::string text_of(const std::optional<FirstContact>& contact) {
  return contact ? fmt::format("t = {:a} side {}", contact->t, int{contact->side}) : "no contact";
}

bool same(const std::optional<FirstContact>& a, const std::optional<FirstContact>& b) {
  if (!a || !b) return !a && !b;
  return std::bit_cast<std::uint32_t>(a->t) == std::bit_cast<std::uint32_t>(b->t) && a->side == b->side;
}

bool is_fp32(double x) {
  return double{static_cast<float>(x)} == x;
}
bool is_fp32(const glm::dvec3& x) {
  return is_fp32(x.x) && is_fp32(x.y) && is_fp32(x.z);
}
bool is_fp32(const Corners& triangle) {
  return is_fp32(triangle.a) && is_fp32(triangle.b) && is_fp32(triangle.c);
}
bool a_trace_can_bring(const ContactCase& c) {
  return is_fp32(c.way.start) && is_fp32(c.way.end) && is_fp32(c.before) && is_fp32(c.after);
}
bool a_trace_can_bring(const SphereCase& c) {
  return c.sphere.radius >= double{kSmallestRadius_m} && is_fp32(c.sphere.centre.start) &&
         is_fp32(c.sphere.centre.end) && is_fp32(c.sphere.radius) && is_fp32(c.before) && is_fp32(c.after);
}

/// Returns answer(), and raises `slowest_s` to its thread time. What would raise it is timed three times, and the least
/// counts: a virtual machine charges a thread for what interrupts it.
template <typename Answer>
auto timed(double& slowest_s, const Answer& answer) {
  double least_s = std::numeric_limits<double>::infinity();
  for (int turn = 1;; ++turn) {
    const double begin_s = thread_cpu_s();
    const auto result = answer();
    least_s = std::min(least_s, thread_cpu_s() - begin_s);
    if (turn < 3 && least_s > slowest_s) continue;
    slowest_s = std::max(slowest_s, least_s);
    return result;
  }
}

}  // namespace

void Agreement::add(const Agreement& other) {
  pairs += other.pairs;
  contacts += other.contacts;
  exact_arithmetic += other.exact_arithmetic;
  differences += other.differences;
  slowest_s = std::max(slowest_s, other.slowest_s);
  for (const std::string& example : other.examples)
    if (examples.size() < kMostExamples) examples.push_back(example);
}

Agreement compare_with_truth(Method method, std::string_view family, std::uint64_t seed, std::uint64_t pairs) {
  Agreement agreement;
  agreement.pairs = pairs;
  CaseGenerator generator(family, seed);
  for (std::uint64_t i = 0; i < pairs; ++i) {
    const ContactCase c = generator.next();
    const bool moves = method == Method::kCcd;
    const auto decide = [&] { return moves ? decide_ccd(c.way, c.before, c.after) : decide_static(c.way, c.after); };
    const Decision decision = a_trace_can_bring(c) ? timed(agreement.slowest_s, decide) : decide();
    const auto truth = moves ? exact::ccd_contact(c.way, c.before, c.after) : exact::static_contact(c.way, c.after);
    if (truth) ++agreement.contacts;
    if (decision.exact_arithmetic) ++agreement.exact_arithmetic;
    if (same(decision.contact, truth)) continue;
    ++agreement.differences;
    if (agreement.examples.size() < kMostExamples)
      agreement.examples.push_back(fmt::format(
          "{} {}: way {{{}, {}}}, before {}, after {}: {}, truth {}", name_of(method), family, text_of(c.way.start),
          text_of(c.way.end), text_of(c.before), text_of(c.after), text_of(decision.contact), text_of(truth)));
  }
  return agreement;
}

Agreement compare_spheres_with_truth(Method method, std::string_view family, std::uint64_t seed, std::uint64_t pairs) {
  Agreement agreement;
  agreement.pairs = pairs;
  CaseGenerator generator(family, seed);
  for (std::uint64_t i = 0; i < pairs; ++i) {
    const SphereCase c = generator.next_sphere();
    const Corners& before = method == Method::kCcd ? c.before : c.after;
    const auto decide = [&] { return decide_sphere(c.sphere, before, c.after); };
    const SphereDecision decision = a_trace_can_bring(c) ? timed(agreement.slowest_s, decide) : decide();
    const auto truth = exact::sphere_contact(c.sphere, before, c.after);
    if (truth) ++agreement.contacts;
    if (decision.exact_arithmetic) ++agreement.exact_arithmetic;
    bool unused = false;
    const int order =
        StartDistance::compare({c.sphere.centre.start, c.before}, {c.sphere.centre.start, c.after}, unused);
    const int true_order =
        exact::compare_distances({c.sphere.centre.start, c.before}, {c.sphere.centre.start, c.after});
    if (decision.touch == truth && order == true_order) continue;
    ++agreement.differences;
    if (agreement.examples.size() < kMostExamples)
      agreement.examples.push_back(fmt::format("{} {}: way {{{}, {}}}, radius {:a}, before {}, after {}: {}, truth {}",
                                               name_of(method), family, text_of(c.sphere.centre.start),
                                               text_of(c.sphere.centre.end), c.sphere.radius, text_of(before),
                                               text_of(c.after), text_of(decision.touch), text_of(truth)));
  }
  return agreement;
}

}  // namespace vestige::test
