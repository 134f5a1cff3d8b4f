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

Trajectory Atlas::trajectory(StartIndex start_index) const {
  const auto [m, start] = id(start_index);
  const Mdp& mdp = domain_.mdp(m);
  return shown_path(mdp, canonical_choices_[m.value()], shown_next_[m.value()], start);
}

std::vector<StartIndex> Atlas::path(StartIndex start) const {
  std::vector<StartIndex> path;
  auto at = static_cast<std::uint32_t>(start.value());
  for (; at != kTerminal && starts_[at].cycle_length == 0; at = starts_[at].next) path.emplace_back(at);
  if (at == kTerminal) return path;
  for (auto left = starts_[at].cycle_length; left > 0; --left, at = starts_[at].next) path.emplace_back(at);
  return path;
}

ActionIndex Atlas::action(StartIndex start_index) const {
  const auto [m, start] = id(start_index);
  return domain_.mdp(m).choices(start)[canonical_choices_[m.value()][start.value()]].action;
}

IntegerVector Atlas::deviation_counts(StartIndex start_index, std::size_t choice) const {
  const auto [m, start] = id(start_index);
  const Mdp& mdp = domain_.mdp(m);
  const auto choices = mdp.choices(start);
  if (choice >= choices.size()) throw std::invalid_argument{"Atlas::deviation_counts: there is no such choice"};
  const IntegerVector nothing(domain_.num_features());
  return counts_of(mdp, choices[choice], domain_.count_scale(), [&, m = m](StateIndex next) -> const IntegerVector& {
    return mdp.is_terminal(next) ? nothing : feature_counts(index({m, next}));
  });
}

void Atlas::refuse_tables() const {
  throw Error{ErrorKind::kInfeasible,
              "what people could expect in domain '" + domain_.id() +
                  "' is not precomputed: that needs three features, exact counts and small worlds"};
}

Atlas Atlas::with_tests(const std::vector<bool>& is_usable) const {
  if (is_usable.size() != num_states()) throw std::invalid_argument{"Atlas::with_tests: one flag per demonstration"};
  auto atlas = *this;
  for (auto& tests : atlas.tests_for_) {
    std::erase_if(tests, [&](StartIndex start) { return !is_usable[start.value()]; });
  }
  return atlas;
}

}  // namespace kith
