#include "atlas_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "one_step.hpp"

namespace kith {

void AtlasBuilder::build() {
  check_domain();
  plan();
  find_indifference();
  reduce_one_step();
  number_constraints();
  make_one_step_sets();
  make_policy_bec();
  count_masks();
  make_components();
  make_facets();
  atlas_.cells_ = PolicyCells{atlas_.hulls_};
  group_demos();
  index_tests();
  average_dissimilarities();
}

void AtlasBuilder::check_domain() const {
  const auto& domain = atlas_.domain_;
  if (domain.num_features() != 3) {
    throw Error{ErrorKind::kInfeasible, "domain '" + domain.id() + "' has " + std::to_string(domain.num_features()) +
                                            " features; regions of weights are computed for exactly 3"};
  }
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto& mdp = domain.mdp(m);
    if (!mdp.is_deterministic() || !mdp.is_integral() || mdp.discount() != 1.0) {
      throw Error{ErrorKind::kInfeasible,
                  "domain '" + domain.id() + "' is not deterministic and undiscounted with integer features"};
    }
  }
}

void AtlasBuilder::plan() {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto& mdp = domain.mdp(m);
    const auto plan = plan_exactly(mdp, domain.weights().integer);
    if (!plan.solution) {
      throw Error{ErrorKind::kInfeasible, "the robot has no finite optimum in world " + std::to_string(m.value()) +
                                              " of domain '" + domain.id() + "'"};
    }
    atlas_.first_demo_.push_back(atlas_.demos_.size());
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
      Atlas::Demo demo;
      demo.id = {m, s};
      demo.counts = plan.solution->feature_counts[s.value()];
      atlas_.demos_.push_back(demo);
    }
    describe_paths(m, *plan.solution);
    collect_one_step(m, *plan.solution);
    find_hulls(m);
    atlas_.canonical_choices_.push_back(plan.solution->canonical_choice);
  }
}

std::uint32_t AtlasBuilder::picture(MdpIndex m, StateIndex s) {
  const auto& state = atlas_.domain_.state(m, s);
  std::vector<std::int64_t> key{state.robot.x, state.robot.y, state.exited ? 1 : 0};
  for (const auto& item : state.items) key.insert(key.end(), {item.x, item.y});
  for (const bool carried : state.carried) key.push_back(carried ? 1 : 0);
  for (const auto& station : state.stations) key.insert(key.end(), {station.x, station.y});
  return pictures_.try_emplace(std::move(key), static_cast<std::uint32_t>(pictures_.size())).first->second;
}

// Ties, uniqueness and trajectory classes, from the end of the paths backwards.
void AtlasBuilder::describe_paths(MdpIndex m, const ExactSolution& robot) {
  const auto& mdp = atlas_.domain_.mdp(m);
  for (const auto s : successors_first(mdp, robot)) {
    auto& here = demo(m, s);
    const auto next = next_state(mdp, robot, s);
    const bool ends = mdp.is_terminal(next);
    here.tie = num_optimal_choices(mdp, robot, atlas_.domain_.weights().integer, s) > 1;
    here.unique = !here.tie && (ends || demo(m, next).unique);
    if (!ends) here.next = static_cast<std::uint32_t>(atlas_.first_demo_[m.value()] + next.value());
    const auto action = mdp.choices(s)[robot.canonical_choice[s.value()]].action.value();
    // What follows: a negative number names the picture of a terminal state.
    const auto rest = ends ? -1 - static_cast<std::int64_t>(picture(m, next))
                           : static_cast<std::int64_t>(demo(m, next).trajectory_class);
    here.trajectory_class = trajectory_classes_
                                .try_emplace({picture(m, s), static_cast<std::int64_t>(action), rest},
                                             static_cast<std::uint32_t>(trajectory_classes_.size()))
                                .first->second;
  }
}

void AtlasBuilder::collect_one_step(MdpIndex m, const ExactSolution& robot) {
  const auto& mdp = atlas_.domain_.mdp(m);
  raw_sets_.resize(atlas_.demos_.size());
  for (const auto s : successors_first(mdp, robot)) {
    const auto& here = demo(m, s);
    auto set = deviations(mdp, robot, s, raw_);
    if (here.next != Atlas::kTerminal) set.insert(set.end(), raw_sets_[here.next].begin(), raw_sets_[here.next].end());
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    raw_sets_[atlas_.first_demo_[m.value()] + s.value()] = std::move(set);
  }
}

// Where paths with different feature counts are equally good, the comparison of
// the two holds with equality at the robot's weights. As long as such
// half-spaces leave a region they are taken as shown. When the robot's choices
// among equals contradict each other, it is indifferent: these comparisons say
// nothing about its reward, and none of them counts.
void AtlasBuilder::find_indifference() {
  const auto& weights = atlas_.domain_.weights().integer;
  std::vector<HalfSpace> ties;
  const auto collect = [&](const HalfSpace& half_space) {
    if (sign_of_dot(half_space.normal(), weights) == 0) ties.push_back(half_space);
  };
  for (ConstraintIndex c{0}; c.value() < raw_.size(); ++c) collect(raw_[c]);
  for (const auto& hull : atlas_.hulls_) {
    for (const auto& loss : hull.losses) {
      if (!loss.is_zero()) collect(HalfSpace{loss});
    }
  }
  indifferent_ = !has_interior(ties);
}

bool AtlasBuilder::counts(const HalfSpace& half_space) const {
  return !indifferent_ || sign_of_dot(half_space.normal(), atlas_.domain_.weights().integer) != 0;
}

void AtlasBuilder::reduce_one_step() {
  IntsMap<std::uint32_t> known;
  for (std::size_t i = 0; i < atlas_.demos_.size(); ++i) {
    std::vector<std::int64_t> key;
    for (const auto c : raw_sets_[i]) key.push_back(static_cast<std::int64_t>(c.value()));
    const auto [place, is_new] = known.try_emplace(std::move(key), static_cast<std::uint32_t>(minimal_sets_.size()));
    if (is_new) {
      std::vector<HalfSpace> half_spaces;
      for (const auto c : raw_sets_[i]) {
        if (counts(raw_[c])) half_spaces.push_back(raw_[c]);
      }
      auto reduced = minimal_set(half_spaces);
      KITH_ASSERT(reduced.has_value());  // weights beside the robot's satisfy all that counts
      minimal_sets_.push_back(std::move(*reduced));
    }
    atlas_.demos_[i].one_step = place->second;
  }
}

void AtlasBuilder::find_hulls(MdpIndex m) {
  const auto& mdp = atlas_.domain_.mdp(m);
  const auto coverage = coverage_sets(mdp);
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    atlas_.coverage_.max = std::max(atlas_.coverage_.max, coverage.vertices(s).size());
    intern_hull(demo(m, s), coverage);
  }
  atlas_.coverage_.vertices += coverage.num_vertices();
  atlas_.coverage_.mean = static_cast<double>(atlas_.coverage_.vertices) / static_cast<double>(atlas_.demos_.size());
}

void AtlasBuilder::intern_hull(Atlas::Demo& here, const CoverageSets& coverage) {
  Hull hull;
  for (const auto& vertex : coverage.vertices(here.id.start)) hull.losses.push_back(here.counts - vertex);
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
  const auto [place, is_new] = hull_index_.try_emplace(std::move(key), atlas_.hulls_.size());
  if (is_new) {
    hull.finite_region = *region;
    atlas_.hulls_.push_back(std::move(hull));
  }
  here.hull = HullIndex{place->second};
}

// Prior first, then the one-step sets, then what counterfactuals can convey.
void AtlasBuilder::number_constraints() {
  auto& table = atlas_.constraints_;
  for (const auto& half_space : atlas_.domain_.prior()) table.add(half_space);
  for (const auto& set : minimal_sets_) {
    for (const auto& half_space : set) table.add(half_space);
  }
  for (const auto& hull : atlas_.hulls_) {
    auto& row = atlas_.hull_constraints_.emplace_back();
    for (const auto& loss : hull.losses) {
      const bool tells = !loss.is_zero() && counts(HalfSpace{loss});
      row.push_back(tells ? static_cast<std::int32_t>(table.add(HalfSpace{loss}).value()) : -1);
    }
  }
}

void AtlasBuilder::make_one_step_sets() {
  for (const auto& set : minimal_sets_) atlas_.one_step_sets_.push_back(atlas_.constraints_.set_of(set));
  atlas_.prior_ = atlas_.constraints_.set_of(atlas_.domain_.prior());
  const auto cone = Cone::intersection(atlas_.domain_.prior());
  if (!cone)
    throw Error{ErrorKind::kInfeasible,
                "the prior of domain '" + atlas_.domain_.id() + "' leaves no region of weights"};
  atlas_.prior_cone_ = *cone;
}

void AtlasBuilder::make_policy_bec() {
  auto all = atlas_.no_constraints();
  for (const auto& set : atlas_.one_step_sets_) all |= set;
  Regions regions{atlas_.constraints_};
  atlas_.policy_bec_ = regions.of(all).minimal;
  atlas_.policy_bec_half_spaces_ = atlas_.constraints_.half_spaces(atlas_.policy_bec_);
  atlas_.policy_bec_area_ = regions.of(atlas_.policy_bec_ | atlas_.prior_).area_sr;
}

void AtlasBuilder::count_masks() {
  const auto d = atlas_.domain_.num_features();
  std::vector<std::vector<std::size_t>> rows(atlas_.one_step_sets_.size(), std::vector<std::size_t>(d, 0));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto c : atlas_.one_step_sets_[i].members()) {
      for (std::size_t k = 0; k < d; ++k) rows[i][k] += atlas_.constraints_[c].normal()[k] != 0 ? 1u : 0u;
    }
  }
  atlas_.mask_counters_.assign(d, 0);
  for (const auto& demo : atlas_.demos_) {
    for (std::size_t k = 0; k < d; ++k) atlas_.mask_counters_[k] += rows[demo.one_step][k];
  }
}

// Features that matter least are masked first; the one that matters most is the
// reference and never masked; the last component masks nothing.
void AtlasBuilder::make_components() {
  std::vector<std::size_t> order(atlas_.mask_counters_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto& z = atlas_.mask_counters_;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return z[a] < z[b]; });
  // Among equal largest counters the later feature is the reference, as the step is last.
  const auto reference = order.back();
  for (const auto k : order) {
    if (k != reference) atlas_.components_.push_back(component(k, reference));
  }
  atlas_.components_.push_back(component(std::nullopt, reference));
}

KnowledgeComponent AtlasBuilder::component(std::optional<std::size_t> masked, std::size_t reference) {
  const auto& domain = atlas_.domain_;
  KnowledgeComponent result;
  result.masked = masked;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (k == reference || k == masked) continue;
    result.name += (result.name.empty() ? "" : "+") + domain.feature_names()[k];
  }
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    result.uses_mdp.push_back(!masked || !domain.has_feature(m, *masked));
  }
  auto all = atlas_.no_constraints();
  for (const auto& demo : atlas_.demos_) {
    if (result.uses_mdp[demo.id.mdp.value()]) all |= atlas_.one_step_sets_[demo.one_step];
  }
  Regions regions{atlas_.constraints_};
  result.constraints = regions.of(all).minimal;
  result.area_sr = regions.of(result.constraints | atlas_.prior_).area_sr;
  return result;
}

void AtlasBuilder::make_facets() {
  for (std::size_t h = 0; h < atlas_.hulls_.size(); ++h) {
    const auto& hull = atlas_.hulls_[h];
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
    atlas_.hull_facets_.push_back(std::move(facets));
  }
}

void AtlasBuilder::group_demos() {
  const auto& domain = atlas_.domain_;
  IntsMap<std::size_t> index;
  std::vector<std::vector<std::int64_t>> hulls_on_path(atlas_.demos_.size());
  const auto conveys = [&](HullIndex h) {
    const auto& row = atlas_.hull_constraints_[h.value()];
    return std::any_of(row.begin(), row.end(), [](std::int32_t c) { return c >= 0; });
  };
  // Paths are at most as long as their MDP has states, so following them is cheap.
  for (std::size_t i = 0; i < atlas_.demos_.size(); ++i) {
    auto& hulls = hulls_on_path[i];
    for (auto at = static_cast<std::uint32_t>(i); at != Atlas::kTerminal; at = atlas_.demos_[at].next) {
      if (conveys(atlas_.demos_[at].hull)) hulls.push_back(static_cast<std::int64_t>(atlas_.demos_[at].hull.value()));
    }
    std::sort(hulls.begin(), hulls.end());
    hulls.erase(std::unique(hulls.begin(), hulls.end()), hulls.end());
    auto key = hulls;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      key.push_back(domain.has_feature(atlas_.demos_[i].id.mdp, k) ? -1 : -2);
    }
    const auto [place, is_new] = index.try_emplace(std::move(key), atlas_.classes_.size());
    if (is_new) {
      auto& fresh = atlas_.classes_.emplace_back();
      for (const auto h : hulls) fresh.hulls.emplace_back(static_cast<std::size_t>(h));
    }
    atlas_.classes_[place->second].members.emplace_back(i);
    atlas_.demos_[i].demo_class = DemoClassIndex{place->second};
  }
}

void AtlasBuilder::index_tests() {
  atlas_.tests_for_.resize(atlas_.constraints_.size());
  for (std::size_t i = 0; i < atlas_.demos_.size(); ++i) {
    const DemoIndex demo{i};
    for (const auto c : atlas_.one_step(demo).members()) {
      if (atlas_.robot_cell_facets(demo).contains(c)) atlas_.tests_for_[c.value()].push_back(demo);
    }
  }
}

void AtlasBuilder::average_dissimilarities() {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto n = domain.mdp(m).num_states();
    std::vector<std::int64_t> sums(n, 0);
    for (StateIndex a{0}; a.value() < n; ++a) {
      for (StateIndex b{a.value() + 1}; b.value() < n; ++b) {
        const int difference = domain.dissimilarity({m, a}, {m, b});
        sums[a.value()] += difference;
        sums[b.value()] += difference;
      }
    }
    for (StateIndex s{0}; s.value() < n; ++s) {
      const double mean = n > 1 ? static_cast<double>(sums[s.value()]) / static_cast<double>(n - 1) : 0.0;
      demo(m, s).mean_dissimilarity = static_cast<int>(std::lround(mean));
    }
  }
}

}  // namespace kith
