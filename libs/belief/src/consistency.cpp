#include "kith/belief/consistency.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace kith {
namespace {

using Subset = std::vector<std::size_t>;

// The side of one of the arrangement's planes: normals_[plane] * sign . w > 0.
struct Side {
  std::size_t plane;
  int sign;
};

// All boundary planes of a prior and of several groups of half-spaces.
class Arrangement {
 public:
  Arrangement(const Cone& prior, std::span<const std::vector<HalfSpace>> groups) {
    prior_ = sides_of(prior.facets());
    for (const auto& group : groups) groups_.push_back(sides_of(group));
    // The coordinate planes, so that every cell has a corner. They belong to nobody.
    for (const IntegerVector& axis : {IntegerVector{1, 0, 0}, IntegerVector{0, 1, 0}, IntegerVector{0, 0, 1}}) {
      (void)side_of(HalfSpace{axis});
    }
  }

  // The largest sets of groups that are satisfied throughout some cell inside the prior.
  [[nodiscard]] std::set<Subset> largest_subsets() {
    for (std::size_t a = 0; a < normals_.size(); ++a) {
      for (std::size_t b = a + 1; b < normals_.size(); ++b) {
        const IntegerVector ray = primitive(cross(normals_[a], normals_[b]));
        visit(ray, a, b);
        visit(-ray, a, b);
      }
    }
    return best_;
  }

 private:
  Side side_of(const HalfSpace& half_space) {
    const HalfSpace opposite = half_space.opposite();
    const bool flip = opposite < half_space;
    const auto [entry, is_new] = index_.try_emplace(flip ? opposite : half_space, normals_.size());
    if (is_new) normals_.push_back(entry->first.normal());
    return {entry->second, flip ? -1 : 1};
  }

  std::vector<Side> sides_of(std::span<const HalfSpace> half_spaces) {
    std::vector<Side> sides;
    for (const HalfSpace& h : half_spaces) sides.push_back(side_of(h));
    return sides;
  }

  // Every cell that has `ray` among its corners. Rays on more than two planes
  // are visited from the first two of these only.
  void visit(const IntegerVector& ray, std::size_t a, std::size_t b) {
    const auto touches = [&](const std::vector<Side>& sides) {
      return std::all_of(sides.begin(), sides.end(),
                         [&](const Side& side) { return side.sign * sign_of_dot(normals_[side.plane], ray) >= 0; });
    };
    if (!touches(prior_)) return;
    near_.clear();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (touches(groups_[g])) near_.push_back(g);
    }
    if (near_.size() < best_size_) return;
    through_.clear();
    for (std::size_t p = 0; p < normals_.size(); ++p) {
      if (p != a && p != b && sign_of_dot(normals_[p], ray) != 0) continue;
      if (p < b && p != a) return;
      through_.push_back(p);
    }
    for (const std::size_t p : through_) {
      visit_sector(ray, p, 1);
      visit_sector(ray, p, -1);
    }
  }

  // The sector about `ray` that begins at the edge turn * (ray x n) of the plane
  // with normal n and continues counter-clockwise, which is towards
  // turn * ray x (ray x n) = -turn |ray|^2 n. The sign of another plane m that
  // holds the ray is that at the edge: turn * m . (ray x n) = turn * ray . (n x m).
  void visit_sector(const IntegerVector& ray, std::size_t plane, int turn) {
    const auto sign_inside = [&](std::size_t p) {
      if (p == plane) return -turn;
      if (const int sign = sign_of_dot(normals_[p], ray); sign != 0) return sign;
      return turn * sign_of_dot(ray, cross(normals_[plane], normals_[p]));
    };
    const auto satisfied = [&](const std::vector<Side>& sides) {
      return std::all_of(sides.begin(), sides.end(),
                         [&](const Side& side) { return side.sign * sign_inside(side.plane) > 0; });
    };
    if (!satisfied(prior_)) return;
    Subset subset;
    for (const std::size_t g : near_) {
      if (satisfied(groups_[g])) subset.push_back(g);
    }
    if (subset.size() < best_size_) return;
    if (subset.size() > best_size_) best_.clear();
    best_size_ = subset.size();
    best_.insert(std::move(subset));
  }

  std::vector<IntegerVector> normals_;      // pairwise not parallel
  std::map<HalfSpace, std::size_t> index_;  // of the normals
  std::vector<Side> prior_;
  std::vector<std::vector<Side>> groups_;
  std::set<Subset> best_;
  std::size_t best_size_ = 0;
  Subset near_;                       // groups whose closed regions hold the current ray
  std::vector<std::size_t> through_;  // planes that hold the current ray
};

// Beyond three dimensions, and on the circle: whoever takes part in a conflict is tried without, by the number of
// groups left out, until some are left that agree. Every largest set lacks an owner of some half-space of every
// conflict, so none is missed.
class ConflictSearch {
 public:
  ConflictSearch(const Cone& prior, std::span<const std::vector<HalfSpace>> groups)
      : prior_{prior.facets().begin(), prior.facets().end()}, groups_{groups} {}

  [[nodiscard]] std::set<Subset> largest_subsets() const {
    std::set<Subset> found;
    std::set<Subset> left_out{Subset{}};
    while (found.empty()) {
      std::set<Subset> next;
      for (const Subset& without : left_out) {
        const auto conflict = conflict_without(without);
        if (conflict.empty()) found.insert(rest(without));
        for (const std::size_t g : owners(conflict, without)) {
          Subset longer = without;
          longer.insert(std::upper_bound(longer.begin(), longer.end(), g), g);
          next.insert(std::move(longer));
        }
      }
      left_out = std::move(next);
    }
    return found;
  }

 private:
  [[nodiscard]] static bool is_in(const Subset& subset, std::size_t g) {
    return std::binary_search(subset.begin(), subset.end(), g);
  }

  [[nodiscard]] std::vector<HalfSpace> conflict_without(const Subset& without) const {
    std::vector<HalfSpace> all = prior_;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!is_in(without, g)) all.insert(all.end(), groups_[g].begin(), groups_[g].end());
    }
    return irreducible_conflict(all);
  }

  // Groups still there with a half-space of the conflict.
  [[nodiscard]] Subset owners(const std::vector<HalfSpace>& conflict, const Subset& without) const {
    Subset result;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const bool takes_part = std::any_of(groups_[g].begin(), groups_[g].end(), [&](const HalfSpace& h) {
        return std::find(conflict.begin(), conflict.end(), h) != conflict.end();
      });
      if (takes_part && !is_in(without, g)) result.push_back(g);
    }
    return result;
  }

  [[nodiscard]] Subset rest(const Subset& without) const {
    Subset result;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!is_in(without, g)) result.push_back(g);
    }
    return result;
  }

  std::vector<HalfSpace> prior_;
  std::span<const std::vector<HalfSpace>> groups_;
};

std::set<Subset> largest_agreeing(const Cone& prior, std::span<const std::vector<HalfSpace>> groups) {
  if (prior.dimension() == 3) return Arrangement{prior, groups}.largest_subsets();
  return ConflictSearch{prior, groups}.largest_subsets();
}

// The prior cut by all half-spaces of the list, if some interior is left.
std::optional<Cone> region_of(std::span<const HalfSpace> list, std::optional<Cone> prior) {
  for (const HalfSpace& h : list) {
    if (prior) prior = prior->clipped(h);
  }
  return prior;
}

// The largest sub-list that leaves a region; of several, the one whose latest
// kept half-space is latest, then whose second latest is, and so on.
std::vector<HalfSpace> reduced(const std::vector<HalfSpace>& list, const Cone& prior) {
  if (region_of(list, prior)) return list;
  std::vector<std::vector<HalfSpace>> single;
  single.reserve(list.size());
  for (const HalfSpace& h : list) single.push_back({h});
  const std::set<Subset> largest = largest_agreeing(prior, single);
  const auto newest = std::max_element(largest.begin(), largest.end(), [](const Subset& a, const Subset& b) {
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  });
  std::vector<HalfSpace> kept;
  kept.reserve(newest->size());
  for (const std::size_t i : *newest) kept.push_back(list[i]);
  return kept;
}

}  // namespace

ConsistentSubsets largest_consistent_subsets(std::span<const std::vector<HalfSpace>> lists, const Cone& prior) {
  ConsistentSubsets result{{}, {lists.begin(), lists.end()}};
  std::optional<Cone> everybody = prior;
  for (const auto& list : lists) everybody = region_of(list, std::move(everybody));
  if (everybody) {
    auto& all = result.subsets.emplace_back(lists.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return result;
  }
  for (auto& list : result.reduced_lists) list = reduced(list, prior);
  const std::set<Subset> largest = largest_agreeing(prior, result.reduced_lists);
  result.subsets.assign(largest.begin(), largest.end());
  return result;
}

}  // namespace kith
