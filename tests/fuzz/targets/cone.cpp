// Intersections of half-spaces. Minimal sets are minimal and the same for any order; directions and rays lie where they
// should, exactly; without an interior there is a smallest conflict.

#include <algorithm>
#include <array>

#include "../half_spaces.hpp"

using namespace kith;
using fuzzing::require;

namespace {

bool has(const std::vector<HalfSpace>& all, const HalfSpace& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

std::vector<HalfSpace> without(std::vector<HalfSpace> all, std::size_t i) {
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  return all;
}

void check_conflict(const std::vector<HalfSpace>& all) {
  const auto conflict = irreducible_conflict(all);
  require(!conflict.empty() && conflict.size() <= all.front().normal().size() + 1,
          "a conflict has at most d + 1 members");
  require(!has_interior(conflict), "a conflict is one");
  for (std::size_t i = 0; i < conflict.size(); ++i) {
    require(has(all, conflict[i]), "a conflict is a subset");
    require(has_interior(without(conflict, i)), "no member of a conflict can be left out");
  }
}

void check_minimal(const Cone& cone, const std::vector<HalfSpace>& all) {
  const auto facets = cone.minimal_set();
  require(fuzzing::intersection(facets, cone.dimension())->minimal_set() == facets, "a minimal set is its own");
  for (const auto& one : all) require(cone.implies(one) && !cone.is_cut_by(one), "every half-space holds");
  for (std::size_t i = 0; i < facets.size(); ++i) {
    require(has(all, facets[i]), "a minimal set is a subset");
    require(!fuzzing::intersection(without(facets, i), cone.dimension())->implies(facets[i]),
            "no facet follows from the others");
  }
}

void check_directions(const Cone& cone, const std::vector<HalfSpace>& all) {
  for (const auto& ray : cone.generators()) require(cone.contains(ray), "generators lie inside");
  const auto inside = cone.interior_direction();
  for (const auto& one : all) require(sign_of_dot(one.normal(), inside) > 0, "the interior direction is inside");
  if (cone.dimension() > 3) return;  // areas take milliseconds there
  const auto area = cone.solid_angle();
  require(area > 0.0 && area <= sphere_area(cone.dimension()) + 1e-12, "areas are those of parts of a sphere");
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.head_bytes = 2, .width = fuzzing::kByFirstByte};

// The first byte chooses how many dimensions there are, the second how large entries are: above three dimensions so
// large that extreme rays are sure to fit.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  constexpr std::array<std::int64_t, 4> kLimits{1, 3, 20, 30'000};
  constexpr std::int64_t kMostBeyondSpace = 60;
  fuzzing::Bytes bytes{input};
  const auto d = bytes.dimension();
  const auto limit = std::min(kLimits[bytes.below(kLimits.size())], d > 3 ? kMostBeyondSpace : kLimits.back());
  const auto all = fuzzing::half_spaces(bytes, 16, limit, d);
  const auto cone = fuzzing::intersection(all, d);
  require(cone.has_value() == has_interior(all), "a cone if there is an interior");
  const auto other = fuzzing::intersection({all.rbegin(), all.rend()}, d);
  require(cone.has_value() == other.has_value(), "the order decides nothing");
  if (!cone) {
    check_conflict(all);
    return Outcome::kRefused;
  }
  require(*cone == *other && cone->minimal_set() == other->minimal_set(), "the order changes nothing");
  check_minimal(*cone, all);
  check_directions(*cone, all);
  return Outcome::kRead;
}
