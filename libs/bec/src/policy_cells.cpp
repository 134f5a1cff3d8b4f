#include "kith/bec/policy_cells.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "kith/core/assert.hpp"
#include "kith/core/hash.hpp"
#include "kith/mdp/coverage_set.hpp"

namespace kith {

/// Splits the sphere until every hull's choice is the same all over each part.
class PolicyCellBuilder {
 public:
  PolicyCellBuilder(std::span<const Hull> hulls, PolicyCells& cells) : hulls_{hulls}, cells_{cells} {
    cells_.num_hulls_ = hulls.size();
    collect_region_planes();
  }

  void build() {
    std::vector<Open> open(hulls_.size());
    for (std::size_t h = 0; h < hulls_.size(); ++h) {
      open[h].hull = h;
      open[h].survivors.resize(hulls_[h].losses.size());
      std::iota(open[h].survivors.begin(), open[h].survivors.end(), PolicyCells::Choice{0});
    }
    decided_.assign(hulls_.size(), PolicyCells::kNone);
    split(Cone{}, std::move(open));
    cells_.num_cells_ = leaves_.size();
  }

 private:
  // A hull whose choice is not yet the same all over the current part.
  struct Open {
    std::size_t hull = 0;
    std::vector<PolicyCells::Choice> survivors;  // vertices that may be chosen somewhere in the part
    bool inside = false;                         // the part lies inside the hull's finite region
  };

  void collect_region_planes() {
    for (const auto& hull : hulls_) {
      const auto facets = hull.finite_region.facets();
      region_planes_.insert(region_planes_.end(), facets.begin(), facets.end());
    }
    std::sort(region_planes_.begin(), region_planes_.end());
    region_planes_.erase(std::unique(region_planes_.begin(), region_planes_.end()), region_planes_.end());
  }

  std::uint32_t split(const Cone& part, std::vector<Open> open) {
    const auto generators = part.generators();
    // Decisions made for this part are undone on the way back up.
    std::vector<std::size_t> decided_here;
    const auto decide = [&](std::size_t hull, PolicyCells::Choice choice) {
      decided_[hull] = choice;
      decided_here.push_back(hull);
    };
    std::map<HalfSpace, std::size_t> votes;
    std::vector<Open> still_open;
    const auto region_plane = cutting_region_plane(part);
    for (auto& candidate : open) {
      if (!candidate.inside) {
        if (region_plane) {
          still_open.push_back(std::move(candidate));
          continue;
        }
        if (!hulls_[candidate.hull].finite_region.contains(part.interior_direction())) {
          decide(candidate.hull, PolicyCells::kNone);
          continue;
        }
        candidate.inside = true;
      }
      prune(candidate, part, generators);
      if (candidate.survivors.size() == 1) {
        decide(candidate.hull, candidate.survivors.front());
      } else {
        const auto& losses = hulls_[candidate.hull].losses;
        ++votes[HalfSpace{losses[candidate.survivors[0]] - losses[candidate.survivors[1]]}];
        still_open.push_back(std::move(candidate));
      }
    }
    const auto node = static_cast<std::uint32_t>(cells_.nodes_.size());
    cells_.nodes_.emplace_back();
    if (still_open.empty()) {
      cells_.nodes_[node].cell = leaf();
    } else {
      const HalfSpace plane = region_plane ? *region_plane : most_wanted(votes);
      cells_.nodes_[node].normal = plane.unit_normal();
      const auto below = part.clipped(plane.opposite());
      const auto above = part.clipped(plane);
      KITH_ASSERT(below && above);
      const auto low = split(*below, still_open);
      const auto high = split(*above, std::move(still_open));
      cells_.nodes_[node].child[0] = low;
      cells_.nodes_[node].child[1] = high;
    }
    for (const auto hull : decided_here) decided_[hull] = PolicyCells::kNone;
    return node;
  }

  [[nodiscard]] std::optional<HalfSpace> cutting_region_plane(const Cone& part) const {
    const auto plane = std::find_if(region_planes_.begin(), region_planes_.end(),
                                    [&](const HalfSpace& candidate) { return part.is_cut_by(candidate); });
    if (plane == region_planes_.end()) return std::nullopt;
    return *plane;
  }

  // Keeps the vertices that are the best somewhere in the part: first those that
  // no single other one beats on all generators, then, among three or more,
  // those with a region of their own.
  void prune(Open& open, const Cone& part, std::span<const IntegerVector> generators) const {
    const auto& losses = hulls_[open.hull].losses;
    auto& alive = open.survivors;
    const auto beaten_by = [&](PolicyCells::Choice i, PolicyCells::Choice j) {
      const auto excess = losses[i] - losses[j];
      return std::all_of(generators.begin(), generators.end(),
                         [&](const IntegerVector& g) { return sign_of_dot(excess, g) >= 0; });
    };
    for (std::size_t i = 0; i < alive.size();) {
      const bool beaten = std::any_of(alive.begin(), alive.end(),
                                      [&](PolicyCells::Choice j) { return j != alive[i] && beaten_by(alive[i], j); });
      if (beaten) {
        alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (alive.size() < 3) return;
    std::vector<IntegerVector> gains;
    gains.reserve(alive.size());
    for (const auto i : alive) gains.push_back(-losses[i]);
    const auto hull = upper_hull(gains, part);
    std::erase_if(alive,
                  [&](PolicyCells::Choice i) { return !std::binary_search(hull.begin(), hull.end(), -losses[i]); });
  }

  // The plane that decides most hulls at once; ties: the lexicographically first.
  [[nodiscard]] static const HalfSpace& most_wanted(const std::map<HalfSpace, std::size_t>& votes) {
    return std::max_element(votes.begin(), votes.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  [[nodiscard]] std::uint32_t leaf() {
    const auto [place, is_new] = leaves_.try_emplace(decided_, static_cast<std::uint32_t>(leaves_.size()));
    if (is_new) cells_.choices_.insert(cells_.choices_.end(), decided_.begin(), decided_.end());
    return place->second;
  }

  std::span<const Hull> hulls_;
  PolicyCells& cells_;
  std::vector<HalfSpace> region_planes_;
  std::vector<PolicyCells::Choice> decided_;
  std::unordered_map<std::vector<PolicyCells::Choice>, std::uint32_t, HashOfList> leaves_;
};

PolicyCells::PolicyCells(std::span<const Hull> hulls) { PolicyCellBuilder{hulls, *this}.build(); }

PolicyCellIndex PolicyCells::locate(const Eigen::Vector3d& weights) const noexcept {
  std::uint32_t at = 0;
  while (nodes_[at].child[0] != kLeaf) at = nodes_[at].child[nodes_[at].normal.dot(weights) >= 0.0 ? 1 : 0];
  return PolicyCellIndex{nodes_[at].cell};
}

std::vector<std::uint32_t> PolicyCells::locate(std::span<const double> x, std::span<const double> y,
                                               std::span<const double> z) const {
  constexpr std::size_t kTogether = 8;  // so that a processor need not wait for one node after the other
  std::vector<std::uint32_t> cells(x.size());
  for (std::size_t begin = 0; begin < x.size(); begin += kTogether) {
    const auto n = std::min(kTogether, x.size() - begin);
    std::array<std::uint32_t, kTogether> at{};
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (std::size_t i = 0; i < n; ++i) {
        const Node& node = nodes_[at[i]];
        if (node.child[0] == kLeaf) continue;
        const Eigen::Vector3d weights{x[begin + i], y[begin + i], z[begin + i]};
        at[i] = node.child[node.normal.dot(weights) >= 0.0 ? 1 : 0];
        goes_on = true;
      }
    }
    for (std::size_t i = 0; i < n; ++i) cells[begin + i] = nodes_[at[i]].cell;
  }
  return cells;
}

}  // namespace kith
