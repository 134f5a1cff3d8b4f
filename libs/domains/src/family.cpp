#include "family.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "explore.hpp"
#include "kith/domains/thinning.hpp"

namespace kith::detail {
namespace {

// Every MDP begins by looking at every cell, which takes much less than a state does.
constexpr std::size_t kMaxCellsPerState = 32;

// The non-terminal states from which some terminal state can be reached.
std::vector<bool> find_live_states(const Exploration& found) {
  const std::size_t n = found.states.size();

  // The edges into each state.
  std::vector<std::uint32_t> first(n + 1, 0);
  for (const auto& edge : found.edges) ++first[edge.to + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> from(found.edges.size());
  std::vector<std::uint32_t> slot(first.begin(), first.end() - 1);
  for (std::uint32_t s = 0; s < n; ++s) {
    for (std::uint32_t e = found.first_edge[s]; e < found.first_edge[s + 1]; ++e) from[slot[found.edges[e].to]++] = s;
  }

  // From there one can come to an end.
  std::vector<bool> live(n, false);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t s = 0; s < n; ++s) {
    if (found.terminal[s]) queue.push_back(s);
  }
  while (!queue.empty()) {
    const std::uint32_t s = queue.back();
    queue.pop_back();
    for (std::uint32_t e = first[s]; e < first[s + 1]; ++e) {
      if (live[from[e]]) continue;
      live[from[e]] = true;
      queue.push_back(from[e]);
    }
  }
  return live;
}

class FamilyBuilder {
 public:
  FamilyBuilder(const FamilyMap& family_map, const Dynamics& dynamics, const DomainLimits& limits, TomlReport& report)
      : family_map_{family_map},
        limits_{limits},
        report_{report},
        dynamics_{dynamics},
        features_{dynamics},
        explorer_{family_map, dynamics, features_} {}

  std::vector<DomainMember> build() {
    const std::size_t num_mdps = family_map_.num_mdps();
    if (!check_size(num_mdps)) return {};
    for (std::size_t mdp = 0; mdp < num_mdps; ++mdp) {
      const Exploration found = explorer_.explore(mdp, limits_.max_states - num_states_);
      if (!found.complete) {
        report_too_many(mdp, num_mdps);
        return {};
      }
      num_states_ += found.states.size();
      add(mdp, found);
    }
    report_failures(num_mdps);
    return std::move(members_);
  }

 private:
  bool check_size(std::size_t num_mdps) {
    const StateLayout& layout = explorer_.layout();
    if (layout.num_bits() <= 64 && family_map_.num_cells() <= kMaxCellsPerState * limits_.max_states / num_mdps)
      return true;
    report_.error("E0219", family_map_.map_place,
                  "the world is too large: " + std::to_string(num_mdps) + " MDPs of " +
                      std::to_string(family_map_.num_cells()) + " cells, " + std::to_string(family_map_.items.size()) +
                      " items and " + std::to_string(family_map_.stations.size()) + " stations");
    return false;
  }

  void report_too_many(std::size_t mdp, std::size_t num_mdps) {
    report_.error("E0219", family_map_.map_place,
                  "more than " + std::to_string(limits_.max_states) + " states in the first " +
                      std::to_string(mdp + 1) + " of " + std::to_string(num_mdps) + " MDPs; at most " +
                      std::to_string(limits_.max_states) + " are built",
                  "use a smaller map, fewer items, stations or optional things, or [family] worlds = NUMBER");
  }

  void add(std::size_t mdp, const Exploration& found) {
    if (found.terminal[0]) {
      ++num_finished_;
      first_finished_ = first_finished_.value_or(mdp);
      return;
    }
    const std::vector<bool> live = find_live_states(found);
    if (!live[0]) {
      ++num_unreachable_;
      first_unreachable_ = first_unreachable_.value_or(mdp);
      return;
    }
    note_dead_ends(mdp, found, live);
    if (num_finished_ + num_unreachable_ == 0) members_.push_back(member(mdp, found, live));
  }

  void note_dead_ends(std::size_t mdp, const Exploration& found, const std::vector<bool>& live) {
    for (std::size_t s = 0; s < live.size(); ++s) {
      if (live[s] || found.terminal[s]) continue;
      if (num_dead_++ == 0) {
        first_dead_ = "robot at " + cell_text(family_map_, explorer_.layout().robot(found.states[s]));
        if (!family_map_.groups.empty()) first_dead_ += " in world " + world_text(family_map_, mdp);
      }
    }
  }

  // Numbers the states: live ones first, then terminal ones, each in the order
  // found. Dead ends are left out with every action that leads to one.
  DomainMember member(std::size_t mdp, const Exploration& found, const std::vector<bool>& live) {
    const std::size_t n = found.states.size();
    std::vector<std::uint32_t> number(n, 0);
    std::vector<PackedState> states;
    for (std::size_t s = 0; s < n; ++s) {
      if (!live[s]) continue;
      number[s] = static_cast<std::uint32_t>(states.size());
      states.push_back(found.states[s]);
    }

    const std::size_t num_live = states.size();
    for (std::size_t s = 0; s < n; ++s) {
      if (!found.terminal[s]) continue;
      number[s] = static_cast<std::uint32_t>(states.size());
      states.push_back(found.states[s]);
    }

    MdpBuilder builder{num_live, states.size() - num_live, dynamics_.actions.size(), dynamics_.features.size(),
                       dynamics_.discount};
    MdpBuilder::Transition transition;
    for (std::size_t s = 0; s < n; ++s) {
      if (!live[s]) continue;
      for (std::uint32_t e = found.first_edge[s]; e < found.first_edge[s + 1]; ++e) {
        const Exploration::Edge& edge = found.edges[e];
        if (!live[edge.to] && !found.terminal[edge.to]) continue;
        transition.next = StateIndex{number[edge.to]};
        transition.features = features_.row(edge.row).features;
        builder.add_choice(StateIndex{number[s]}, ActionIndex{edge.action}, std::span{&transition, 1});
      }
    }
    return finished_member(mdp, std::move(builder).build(), std::move(states));
  }

  DomainMember finished_member(std::size_t mdp, Mdp process, std::vector<PackedState> states) {
    DomainMember member{std::move(process), std::move(states), {}, {}, {}, 0};
    member.starts = spread_states(member.mdp, family_map_.thinning.starts.value_or(member.mdp.num_states()));
    member.by_state.resize(member.states.size());
    std::iota(member.by_state.begin(), member.by_state.end(), 0U);
    std::sort(member.by_state.begin(), member.by_state.end(),
              [&](std::uint32_t a, std::uint32_t b) { return member.states[a] < member.states[b]; });
    for (const Item& item : family_map_.items) {
      member.item_present.push_back(family_map_.find(item.homes, mdp).has_value());
    }
    for (std::size_t group = 0; group < family_map_.groups.size(); ++group) {
      if (!family_map_.is_on(group, mdp)) continue;
      for (const MapThing& thing : family_map_.groups[group].things) {
        SymbolContent rest = family_map_.symbols[thing.symbol].content;
        rest.station.clear();
        member.num_toggled += rest.is_floor() ? 0 : 1;
      }
    }
    return member;
  }

  [[nodiscard]] TomlPlace goal_place() const {
    return family_map_.some_goal ? family_map_.goal_place : family_map_.map_place;
  }

  void report_failures(std::size_t num_mdps) {
    const auto in_some = [&](std::size_t number) {
      return num_mdps == 1 ? "" : " in " + std::to_string(number) + " of " + std::to_string(num_mdps) + " worlds";
    };
    const auto first = [&](std::size_t mdp) {
      return num_mdps == 1 ? "" : "first failing world: " + world_text(family_map_, mdp);
    };
    if (num_unreachable_ > 0) {
      report_.infeasible("E0207", goal_place(), "the goal cannot be reached from the start" + in_some(num_unreachable_),
                         first(*first_unreachable_));
    }
    if (num_finished_ > 0) {
      report_.infeasible("E0221", family_map_.start_place,
                         "there is nothing to do: the episode ends at the start" + in_some(num_finished_),
                         first(*first_finished_));
    }
    if (num_dead_ > 0) {
      report_.warning("W0202", family_map_.map_place,
                      "left out " + std::to_string(num_dead_) + " states from which the goal cannot be reached",
                      "the first: " + first_dead_);
    }
  }

  const FamilyMap& family_map_;
  const DomainLimits& limits_;
  TomlReport& report_;
  const Dynamics& dynamics_;
  FeatureTable features_;
  Explorer explorer_;
  std::vector<DomainMember> members_;
  std::size_t num_states_ = 0;
  std::size_t num_finished_ = 0;
  std::size_t num_unreachable_ = 0;
  std::size_t num_dead_ = 0;
  std::optional<std::size_t> first_finished_;
  std::optional<std::size_t> first_unreachable_;
  std::string first_dead_;
};

}  // namespace

std::vector<DomainMember> build_family(const FamilyMap& family_map, const Dynamics& dynamics,
                                       const DomainLimits& limits, TomlReport& report) {
  return FamilyBuilder{family_map, dynamics, limits, report}.build();
}

}  // namespace kith::detail
