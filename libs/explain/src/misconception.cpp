#include "kith/explain/misconception.hpp"

#include "kith/explain/words.hpp"
#include "side.hpp"

namespace kith {
namespace {

using detail::Side;

// The normal of what the person satisfies.
IntegerVector satisfied_normal(const Misbelief& misbelief) {
  auto normal = misbelief.violated.normal();
  normal[misbelief.unit] = misbelief.limit.value();
  return normal;
}

bool is_zero(const IntegerVector& normal) {
  for (std::size_t k = 0; k < normal.size(); ++k) {
    if (normal[k] != 0) return false;
  }
  return true;
}

bool is_heavier(const Domain& domain, const IntegerVector& normal, std::size_t k) {
  return (domain.weights().integer[k] < 0) == (normal[k] < 0);
}

// One side of an inequality.
Side side_of(const Domain& domain, const IntegerVector& normal, bool heavier) {
  Side side;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (normal[k] == 0 || is_heavier(domain, normal, k) != heavier) continue;
    side.add(detail::thing(domain.wording(k), normal[k] < 0 ? -normal[k] : normal[k]), domain.weights().integer[k] < 0);
  }
  return side;
}

// Behind "more than": "2 steps", "what 2 steps cost".
std::string amount(const Side& subject, const Side& object) {
  const bool same_kind = subject.costs.empty() == object.costs.empty();
  return same_kind ? object.words() : "what " + object.words() + " " + object.verb();
}

// The inequality told of the side that does not have the unit: "crossing rubble costs ...". Nothing if the words of the
// domain do not allow it.
std::optional<std::string> about_subject(const Domain& domain, const Misbelief& misbelief) {
  const auto& normal = misbelief.violated.normal();
  // The robot's subject outweighs the object, or is outweighed by it.
  const bool outweighs = normal[misbelief.unit] == 0 || !is_heavier(domain, normal, misbelief.unit);
  const auto subject = side_of(domain, normal, outweighs);
  const auto object = side_of(domain, normal, !outweighs);
  if (subject.empty() || !subject.can_be_said() || !object.can_be_said()) return std::nullopt;
  if (object.empty() && !outweighs) return std::nullopt;
  const bool is_even = sign_of_dot(domain.weights().integer, normal) == 0;
  const auto start = subject.words() + " " + subject.verb() + " ";
  // The limit, if the unit stays on the side of the object.
  std::optional<Side> limit;
  if (misbelief.limit) {
    const auto satisfied = satisfied_normal(misbelief);
    const bool stays = satisfied[misbelief.unit] == 0 || is_heavier(domain, satisfied, misbelief.unit) != outweighs;
    if (stays) limit = side_of(domain, satisfied, !outweighs);
    if (limit && !limit->can_be_said()) limit.reset();
  }
  if (outweighs) {
    if (object.empty()) return start + (is_even ? "less than nothing" : "nothing");
    const auto at_most = (is_even ? "less than " : "at most ") + amount(subject, object);
    if (!limit) return start + at_most;
    return start + (limit->empty() ? "something" : "more than " + amount(subject, *limit)) + ", but " + at_most;
  }
  const auto at_least = start + (is_even ? "more than " : "at least ") + amount(subject, object);
  return limit && !limit->empty() ? at_least + ", but less than " + amount(subject, *limit) : at_least;
}

}  // namespace

std::optional<HalfSpace> Misbelief::satisfied() const {
  if (!limit) return std::nullopt;
  return HalfSpace{satisfied_normal(*this)};
}

std::optional<Misbelief> weakened(const Domain& domain, const HalfSpace& violated, std::size_t unit, std::int64_t n) {
  const std::int64_t sign = domain.weights().integer[unit] < 0 ? -1 : 1;
  Misbelief result{.violated = violated, .limit = violated.normal()[unit] + sign * n, .unit = unit};
  if (is_zero(satisfied_normal(result))) return std::nullopt;
  return result;
}

std::string in_words(const Domain& domain, const Misbelief& misbelief) {
  if (const auto text = about_subject(domain, misbelief)) return *text;
  return in_words(domain, misbelief.violated.opposite());
}

}  // namespace kith
