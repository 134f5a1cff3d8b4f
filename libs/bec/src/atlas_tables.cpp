// Coverage sets and what follows from them, where behaviours are tabulated.
#include <algorithm>

#include "atlas_builder.hpp"

namespace kith {

void AtlasBuilder::find_hulls(MdpIndex m) {
  const auto& mdp = atlas_.domain_.mdp(m);
  const auto coverage = coverage_sets(mdp);
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    tables_->coverage_.max = std::max(tables_->coverage_.max, coverage.vertices(s).size());
    intern_hull(atlas_.index({m, s}), coverage);
  }
  tables_->coverage_.vertices += coverage.num_vertices();
  tables_->coverage_.mean =
      static_cast<double>(tables_->coverage_.vertices) / static_cast<double>(atlas_.starts_.size());
}

void AtlasBuilder::intern_hull(StartIndex here, const CoverageSets& coverage) {
  const auto& counts = atlas_.feature_counts(here);
  Hull hull;
  for (const auto& vertex : coverage.vertices(atlas_.id(here).start)) hull.losses.push_back(counts - vertex);
  const auto& weights = atlas_.domain_.weights().integer;
  std::sort(hull.losses.begin(), hull.losses.end(), [&](const IntegerVector& a, const IntegerVector& b) {
    const auto loss_a = dot(weights, a);
    const auto loss_b = dot(weights, b);
    return loss_a != loss_b ? loss_a < loss_b : a < b;
  });
  auto region = std::find(regions_.begin(), regions_.end(), coverage.finite_region());
  if (region == regions_.end()) region = regions_.insert(regions_.end(), coverage.finite_region());
  std::vector<std::int64_t> key{region - regions_.begin()};
  for (const auto& loss : hull.losses) key.insert(key.end(), loss.begin(), loss.end());
  const auto [place, is_new] = hull_index_.try_emplace(std::move(key), tables_->hulls_.size());
  if (is_new) {
    hull.finite_region = *region;
    tables_->hulls_.push_back(std::move(hull));
  }
  tables_->starts_.push_back({counts, HullIndex{place->second}});
}

void AtlasBuilder::make_facets() {
  for (std::size_t h = 0; h < tables_->hulls_.size(); ++h) {
    const auto& hull = tables_->hulls_[h];
    auto facets = atlas_.no_constraints();
    std::optional<Cone> cell = hull.finite_region;
    for (const auto& loss : hull.losses) {
      if (cell && !loss.is_zero() && counts(HalfSpace{loss})) cell = cell->clipped(HalfSpace{loss});
    }
    if (cell) {
      const auto outer = hull.finite_region.facets();
      for (const auto& facet : cell->facets()) {
        if (std::find(outer.begin(), outer.end(), facet) == outer.end())
          facets.insert(*atlas_.constraints_.find(facet));
      }
    }
    tables_->facets_.push_back(std::move(facets));
  }
}

void AtlasBuilder::group_by_hulls() {
  const auto& domain = atlas_.domain_;
  IntsMap<std::size_t> index;
  std::vector<std::vector<std::int64_t>> hulls_on_path(atlas_.starts_.size());
  const auto conveys = [&](HullIndex h) {
    const auto& row = tables_->constraints_[h.value()];
    return std::any_of(row.begin(), row.end(), [](std::int32_t c) { return c >= 0; });
  };

  // Paths are at most as long as their MDP has states, so following them is cheap.
  for (std::size_t i = 0; i < atlas_.starts_.size(); ++i) {
    auto& hulls = hulls_on_path[i];
    for (auto at = static_cast<std::uint32_t>(i); at != Atlas::kTerminal; at = atlas_.starts_[at].next) {
      const auto hull = tables_->starts_[at].hull;
      if (conveys(hull)) hulls.push_back(static_cast<std::int64_t>(hull.value()));
    }
    std::sort(hulls.begin(), hulls.end());
    hulls.erase(std::unique(hulls.begin(), hulls.end()), hulls.end());
    auto key = hulls;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      key.push_back(domain.mdp(atlas_.starts_[i].id.mdp).has_feature(k) ? -1 : -2);
    }
    const auto [place, is_new] = index.try_emplace(std::move(key), atlas_.classes_.size());
    if (is_new) {
      atlas_.classes_.emplace_back();
      auto& of_class = tables_->hulls_of_class_.emplace_back();
      for (const auto h : hulls) of_class.emplace_back(static_cast<std::size_t>(h));
    }
    atlas_.classes_[place->second].emplace_back(i);
    atlas_.starts_[i].start_class = StartClassIndex{place->second};
  }
  tables_->num_constraints_ = atlas_.constraints_.size();
}

}  // namespace kith
