#include "kith/bec/atlas.hpp"

#include <algorithm>
#include <stdexcept>

#include "atlas_builder.hpp"
#include "kith/core/error.hpp"
#include "robot_plan.hpp"

namespace kith {

Atlas::Atlas(Domain domain, BehaviourSource source) : domain_{std::move(domain)} {
  AtlasBuilder{*this, source}.build();
}

Trajectory Atlas::trajectory(DemoIndex demo) const {
  const auto [m, start] = id(demo);
  const Mdp& mdp = domain_.mdp(m);
  return shown_path(mdp, canonical_choices_[m.value()], shown_next_[m.value()], start);
}

std::vector<DemoIndex> Atlas::path(DemoIndex demo) const {
  std::vector<DemoIndex> path;
  auto at = static_cast<std::uint32_t>(demo.value());
  for (; at != kTerminal && demos_[at].cycle_length == 0; at = demos_[at].next) path.emplace_back(at);
  if (at == kTerminal) return path;
  for (auto left = demos_[at].cycle_length; left > 0; --left, at = demos_[at].next) path.emplace_back(at);
  return path;
}

ActionIndex Atlas::action(DemoIndex demo) const {
  const auto [m, start] = id(demo);
  return domain_.mdp(m).choices(start)[canonical_choices_[m.value()][start.value()]].action;
}

IntegerVector Atlas::deviation_counts(DemoIndex demo, std::size_t choice) const {
  const auto [m, start] = id(demo);
  const Mdp& mdp = domain_.mdp(m);
  const auto choices = mdp.choices(start);
  if (choice >= choices.size()) throw std::invalid_argument{"Atlas::deviation_counts: there is no such choice"};
  const IntegerVector nothing(domain_.num_features());
  return counts_of(mdp, choices[choice], domain_.count_scale(), [&, m = m](StateIndex next) -> const IntegerVector& {
    return mdp.is_terminal(next) ? nothing : feature_counts(index({m, next}));
  });
}

std::vector<IntegerVector> Atlas::coverage_set(DemoIndex demo) const {
  if (!tabulated_) {
    throw Error{ErrorKind::kInfeasible,
                "what people could expect in domain '" + domain_.id() +
                    "' is not precomputed: that needs three features, exact counts and small worlds"};
  }
  std::vector<IntegerVector> vertices;
  for (const auto& loss : hulls_[hull(demo).value()].losses) vertices.push_back(feature_counts(demo) - loss);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

std::optional<IntegerVector> Atlas::answer(DemoIndex demo, PolicyCellIndex cell) const {
  const auto choice = cells_.choice(cell, hull(demo));
  if (choice == PolicyCells::kNone) return std::nullopt;
  return feature_counts(demo) - hulls_[hull(demo).value()].losses[choice];
}

Atlas Atlas::with_tests(const std::vector<bool>& is_usable) const {
  if (is_usable.size() != num_demos()) throw std::invalid_argument{"Atlas::with_tests: one flag per demonstration"};
  auto atlas = *this;
  for (auto& tests : atlas.tests_for_) {
    std::erase_if(tests, [&](DemoIndex demo) { return !is_usable[demo.value()]; });
  }
  return atlas;
}

void Atlas::add_conveyed(HullIndex h, std::span<const PolicyCellIndex> cells, std::span<std::uint64_t> row) const {
  const auto& constraint_of = hull_constraints_[h.value()];
  for (const auto cell : cells) {
    const auto choice = cells_.choice(cell, h);
    if (choice == PolicyCells::kNone || constraint_of[choice] < 0) continue;
    const auto c = static_cast<std::size_t>(constraint_of[choice]);
    row[c / 64] |= std::uint64_t{1} << (c % 64);
  }
}

std::vector<std::uint64_t> Atlas::conveyed_by_class(std::span<const PolicyCellIndex> cells) const {
  const auto words = words_per_set();
  std::vector<std::uint64_t> by_hull(hulls_.size() * words, 0);
  for (std::size_t h = 0; h < hulls_.size(); ++h) {
    add_conveyed(HullIndex{h}, cells, std::span{by_hull}.subspan(h * words, words));
  }
  std::vector<std::uint64_t> by_class(classes_.size() * words, 0);
  for (std::size_t c = 0; c < classes_.size(); ++c) {
    for (const auto h : classes_[c].hulls) {
      for (std::size_t i = 0; i < words; ++i) by_class[c * words + i] |= by_hull[h.value() * words + i];
    }
  }
  return by_class;
}

ConstraintSet Atlas::conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells) const {
  auto set = no_constraints();
  for (const auto h : classes_[demo_class(demo).value()].hulls) add_conveyed(h, cells, set.words());
  return set;
}

}  // namespace kith
