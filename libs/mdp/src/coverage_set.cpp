#include "kith/mdp/coverage_set.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>

#include "checks.hpp"
#include "hull_pruner.hpp"
#include "kith/core/error.hpp"
#include "kith/mdp/planner.hpp"
#include "longest_path.hpp"

namespace kith {

using detail::Counts;
using detail::HullPruner;

namespace {

constexpr std::size_t kDimension = 3;

Counts to_counts(const IntegerVector& v) { return {v[0], v[1], v[2]}; }
IntegerVector to_vector(const Counts& v) { return IntegerVector{v[0], v[1], v[2]}; }

[[noreturn]] void infeasible(const std::string& reason) {
  throw Error{ErrorKind::kInfeasible, "coverage_sets: " + reason};
}

// The sum of the features of a positive cycle under `weights`, if there is one.
std::optional<IntegerVector> positive_cycle(const Mdp& mdp, const IntegerVector& weights) {
  detail::LongestPaths paths{mdp, detail::row_rewards(mdp, weights, "coverage_sets")};
  if (paths.solve_to_anywhere()) return std::nullopt;
  return paths.cycle_features();
}

// Cuts the sphere by cycles until none gains at any generator, hence anywhere in the cone.
Cone cut_finite_region(const Mdp& mdp) {
  Cone region;
  std::unordered_set<IntegerVector> settled;
  for (bool cut = true; cut;) {
    cut = false;
    for (const IntegerVector& g : region.generators()) {
      if (settled.contains(g)) continue;
      const auto gain = positive_cycle(mdp, g);
      if (!gain) {
        settled.insert(g);
        continue;
      }
      auto rest = region.clipped(HalfSpace{-*gain});
      if (!rest) infeasible("under any reward weights, some cycle gains reward");
      region = std::move(*rest);
      cut = true;
      break;
    }
  }
  return region;
}

}  // namespace

std::span<const IntegerVector> CoverageSets::vertices(StateIndex s) const {
  detail::require(s.value() + 1 < first_.size(), "CoverageSets::vertices", "the state must not be terminal");
  return std::span{vertices_}.subspan(first_[s.value()], first_[s.value() + 1] - first_[s.value()]);
}

// One run of coverage_sets().
class CoverageSolver {
 public:
  explicit CoverageSolver(const Mdp& mdp) : mdp_{mdp} {}

  CoverageSets solve() {
    require_solvable();
    CoverageSets result;
    result.finite_region_ = cut_finite_region(mdp_);
    // Strictly inside, every cycle loses unless its features cancel, and then it does so everywhere.
    const auto inside = plan_exactly(mdp_, result.finite_region_.interior_direction());
    if (!inside.solution) infeasible("the features of a cycle sum to zero, so that it costs nothing under any weights");
    sweep(HullPruner{result.finite_region_});
    collect(result);
    return result;
  }

 private:
  void require_solvable() const {
    detail::require_exact(mdp_, kDimension, "coverage_sets");
    detail::require(has_small_counts(mdp_), "coverage_sets", "feature counts must stay below 2^31");
    if (mdp_.by_distance().size() < mdp_.num_states()) infeasible("from some state no terminal state can be reached");
  }

  // Sets grow from the terminal states; a state is passed on to those before it whenever its set changed.
  void sweep(HullPruner pruner) {
    const std::size_t all_states = mdp_.num_states() + mdp_.num_terminals();
    sets_.assign(all_states, {});
    std::vector<Counts> rows;
    for (std::size_t row = 0; row < mdp_.num_feature_rows(); ++row) {
      rows.push_back(to_counts(mdp_.integer_feature_row(row)));
    }
    std::vector<unsigned char> queued(all_states, 0);
    std::vector<std::size_t> queue;  // first in, first out: by distance on the first visit
    for (std::size_t t = mdp_.num_states(); t < all_states; ++t) {
      sets_[t] = {Counts{}};
      queue.push_back(t);
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::size_t next = queue[head];
      queued[next] = 0;
      for (const Arrival& arrival : mdp_.arrivals(StateIndex{next})) {
        const std::size_t from = arrival.from.value();
        if (!pruner.merge(sets_[from], rows[arrival.feature_row], sets_[next]) || queued[from] != 0) continue;
        queued[from] = 1;
        queue.push_back(from);
      }
    }
  }

  void collect(CoverageSets& result) {
    result.first_.push_back(0);
    for (std::size_t s = 0; s < mdp_.num_states(); ++s) {
      auto& set = sets_[s];
      std::ranges::sort(set);
      for (const Counts& mu : set) result.vertices_.push_back(to_vector(mu));
      result.first_.push_back(result.vertices_.size());
    }
  }

  const Mdp& mdp_;
  std::vector<std::vector<Counts>> sets_;  // shape [num_states + num_terminals]
};

bool has_small_counts(const Mdp& mdp) noexcept {
  return mdp.largest_feature() * static_cast<double>(mdp.num_states() + 1) < 0x1p31;
}

CoverageSets coverage_sets(const Mdp& mdp) { return CoverageSolver{mdp}.solve(); }

std::vector<IntegerVector> upper_hull(std::span<const IntegerVector> vectors, const Cone& region) {
  std::vector<Counts> more;
  for (const IntegerVector& v : vectors) {
    detail::require(v.size() == kDimension, "upper_hull", "vectors must have three entries");
    more.push_back(to_counts(v));
  }
  std::vector<Counts> set;
  HullPruner{region}.merge(set, Counts{}, more);
  std::ranges::sort(set);
  std::vector<IntegerVector> hull;
  hull.reserve(set.size());
  for (const Counts& v : set) hull.push_back(to_vector(v));
  return hull;
}

}  // namespace kith
