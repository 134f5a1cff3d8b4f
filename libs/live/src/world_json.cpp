#include "kith/live/world_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kith/explain/move_table.hpp"

namespace kith {
namespace {

const Choice* choice_of(const Mdp& mdp, StateIndex s, std::size_t action) {
  for (const auto& choice : mdp.choices(s)) {
    if (choice.action.value() == action) return &choice;
  }
  return nullptr;
}

// What is judged where a path's counts alone do not say it; see docs/model.md.
class ExpectedCounts {
 public:
  ExpectedCounts(const Atlas& atlas, MdpIndex world, const Trajectory& path)
      : atlas_{atlas},
        world_{world},
        mdp_{atlas.domain().mdp(world)},
        path_{path},
        scale_{static_cast<double>(atlas.domain().count_scale())} {}

  [[nodiscard]] IntegerVector counts() const {
    std::vector<double> ahead(mdp_.num_features(), 0.0);
    if (path_.repeats_from) {
      // m = c + K m, with c what one round counts and K the discounted chance of going round.
      double weight = 1.0;
      for (auto t = path_.actions.size(); t-- > *path_.repeats_from;) weight *= go_back(t, ahead);
      for (double& m : ahead) m /= 1.0 - weight;
    }
    for (auto t = path_.actions.size(); t-- > 0;) go_back(t, ahead);
    IntegerVector counts(ahead.size());
    for (std::size_t k = 0; k < ahead.size(); ++k) counts[k] = std::llround(ahead[k] * scale_);
    return counts;
  }

 private:
  // From what is counted behind step t to what is counted from it on; returns how much the former weighs in the latter.
  double go_back(std::size_t t, std::vector<double>& ahead) const {
    std::vector<double> here(ahead.size(), 0.0);
    double weight = 0.0;
    for (const auto& outcome : mdp_.outcomes(*choice_of(mdp_, path_.states[t], path_.actions[t].value()))) {
      const auto features = mdp_.features(outcome);
      const bool as_expected = outcome.next == path_.states[t + 1];
      const bool ends = mdp_.is_terminal(outcome.next);
      if (as_expected) weight += outcome.probability * mdp_.discount();
      for (std::size_t k = 0; k < here.size(); ++k) {
        double rest = 0.0;
        if (as_expected) {
          rest = ahead[k];
        } else if (!ends) {
          rest = static_cast<double>(atlas_.feature_counts(atlas_.index({world_, outcome.next}))[k]) / scale_;
        }
        here[k] += outcome.probability * (features[k] + mdp_.discount() * rest);
      }
    }
    ahead = std::move(here);
    return weight;
  }

  const Atlas& atlas_;
  MdpIndex world_;
  const Mdp& mdp_;
  const Trajectory& path_;
  double scale_;
};

ActionIndex robot_action(const Atlas& atlas, MdpIndex world, StateIndex s) {
  return atlas.action(atlas.index({world, s}));
}

bool does_as_the_robot(const Atlas& atlas, MdpIndex world, const Trajectory& path) {
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    if (path.actions[t] != robot_action(atlas, world, path.states[t])) return false;
  }
  return true;
}

}  // namespace

std::string world_key(const LiveStudy& study, MdpIndex world) {
  return study.key + "-" + std::to_string(world.value());
}

std::optional<MdpIndex> world_of_key(const LiveStudy& study, std::string_view key) {
  const auto start = study.key + "-";
  if (key.size() <= start.size() || key.substr(0, start.size()) != start) return std::nullopt;
  const auto digits = key.substr(start.size());
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (failure != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  if (number >= study.atlas->domain().num_mdps() || std::to_string(number) != digits) return std::nullopt;
  return MdpIndex{number};
}

Json world_json(const LiveStudy& study, MdpIndex world) {
  Json table{{"key", world_key(study, world)}};
  table.update(move_table_json(study.atlas->domain(), world));
  table["max_actions"] = max_answer_actions(study.atlas->domain());
  return table;
}

std::optional<std::size_t> world_state(const LiveStudy& study, MdpIndex world, StateIndex state) {
  const auto& mdp = study.atlas->domain().mdp(world);
  if (state.value() >= mdp.num_states() + mdp.num_terminals()) return std::nullopt;
  return state.value();
}

JudgedPath judged_path(const Atlas& atlas, StartIndex test, std::span<const std::size_t> actions, bool for_ever) {
  const auto [world, start] = atlas.id(test);
  const auto& domain = atlas.domain();
  const auto& mdp = domain.mdp(world);
  JudgedPath judged;
  judged.path.states.push_back(start);
  const auto most = max_answer_actions(domain);
  for (const auto action : actions) {
    const auto here = judged.path.states.back();
    const auto* choice = mdp.is_terminal(here) ? nullptr : choice_of(mdp, here, action);
    judged.is_too_long = choice != nullptr && judged.legal == most;
    if (choice == nullptr || judged.is_too_long) {
      judged.is_legal = false;
      break;
    }
    judged.path.actions.push_back(choice->action);
    judged.path.states.push_back(likeliest_outcome(mdp, here, *choice).next);
    ++judged.legal;
  }
  judged.is_finished = mdp.is_terminal(judged.path.states.back());
  if (for_ever) {
    // The last time that it was there: from then on it goes round.
    const auto& states = judged.path.states;
    const auto met = std::find(states.rbegin() + 1, states.rend(), states.back());
    judged.is_legal = judged.is_legal && !judged.is_finished && met != states.rend();
    if (!judged.is_legal) return judged;
    judged.path.repeats_from = static_cast<std::size_t>(states.rend() - met) - 1;
    judged.is_finished = mdp.discount() < 1.0;
  }
  if (!judged.is_finished || !judged.is_legal) return judged;
  if (does_as_the_robot(atlas, world, judged.path)) {
    judged.counts = atlas.feature_counts(test);  // to the last bit, however expectations are rounded
  } else if (domain.is_exact()) {
    IntegerVector counts(domain.num_features());
    for (std::size_t t = 0; t < judged.path.actions.size(); ++t) {
      counts += mdp.integer_features(likeliest_outcome(
          mdp, judged.path.states[t], *choice_of(mdp, judged.path.states[t], judged.path.actions[t].value())));
    }
    judged.counts = counts;
  } else {
    judged.counts = ExpectedCounts{atlas, world, judged.path}.counts();
  }
  return judged;
}

std::optional<Trajectory> answerable_path(const Atlas& atlas, StartIndex test) {
  const auto [world, start] = atlas.id(test);
  const auto& mdp = atlas.domain().mdp(world);
  const auto most = max_answer_actions(atlas.domain());
  if (mdp.is_deterministic()) {
    auto path = atlas.trajectory(test);
    return path.actions.size() <= most ? std::optional{std::move(path)} : std::nullopt;
  }
  Trajectory path{{start}, {}};
  while (!mdp.is_terminal(path.states.back())) {
    if (path.actions.size() == most) return std::nullopt;
    const auto here = path.states.back();
    path.actions.push_back(robot_action(atlas, world, here));
    path.states.push_back(likeliest_outcome(mdp, here, *choice_of(mdp, here, path.actions.back().value())).next);
  }
  return path;
}

Trajectory expected_path(const Atlas& atlas, StartIndex test) {
  auto path = answerable_path(atlas, test);
  return path ? *std::move(path) : atlas.trajectory(test);
}

}  // namespace kith
