#include "kith/live/world_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kith/explain/words.hpp"

namespace kith {
namespace {

// The likeliest outcome that changes the state: an action that mostly has no effect can still be worth trying.
const Outcome& likeliest(const Mdp& mdp, StateIndex s, const Choice& choice) {
  const auto outcomes = mdp.outcomes(choice);
  return *std::max_element(outcomes.begin(), outcomes.end(), [&](const Outcome& a, const Outcome& b) {
    const double of_a = a.next == s ? 0.0 : a.probability;
    const double of_b = b.next == s ? 0.0 : b.probability;
    return of_a < of_b;
  });
}

class WorldTable {
 public:
  WorldTable(const LiveStudy& study, MdpIndex world)
      : study_{study},
        domain_{study.atlas->domain()},
        world_{world},
        mdp_{domain_.mdp(world)},
        map_{domain_.drawing()},
        num_states_{mdp_.num_states() + mdp_.num_terminals()} {}

  [[nodiscard]] Json json() {
    Json table{{"key", world_key(study_, world_)}, {"actions", actions()}};
    if (map_) {
      collect_stations();
      Json items = Json::array();
      for (const auto i : map_->items_in(world_)) items.push_back(map_->item_names()[i]);
      Json stations = Json::array();
      for (const auto& cell : stations_) stations.push_back(position(cell));
      table["items"] = std::move(items);
      table["stations"] = std::move(stations);
    }
    Json frames = Json::array(), next = Json::array(), end = Json::array();
    for (StateIndex s{0}; s.value() < num_states_; ++s) {
      frames.push_back(frame(s));
      next.push_back(moves(s));
      end.push_back(mdp_.is_terminal(s));
    }
    table["frames"] = std::move(frames);
    table["next"] = std::move(next);
    table["end"] = std::move(end);
    table["chance"] = !mdp_.is_deterministic();
    table["may_repeat"] = mdp_.discount() < 1.0;
    table["max_actions"] = max_answer_actions(domain_);
    return table;
  }

 private:
  // Column and row from the top left, from 1.
  [[nodiscard]] Json position(const Cell& cell) const { return Json::array({cell.x, map_->height() + 1 - cell.y}); }

  // Where an action moves the robot most often, if it moves it at all.
  [[nodiscard]] Json actions() const {
    std::vector<std::map<std::pair<int, int>, std::size_t>> shifts(mdp_.num_actions());
    for (StateIndex s{0}; map_ && s.value() < mdp_.num_states(); ++s) {
      const auto from = map_->state(world_, s);
      for (const auto& choice : mdp_.choices(s)) {
        const auto to = map_->state(world_, likeliest(mdp_, s, choice).next);
        if (to.exited) continue;
        ++shifts[choice.action.value()][{to.robot.x - from.robot.x, from.robot.y - to.robot.y}];
      }
    }
    Json list = Json::array();
    for (std::size_t a = 0; a < mdp_.num_actions(); ++a) {
      const auto& name = domain_.action_names()[a];
      auto label = action_infinitive(name);
      if (label == "do '" + name + "'") label = name;
      Json action{{"name", name}, {"label", label}, {"dx", nullptr}, {"dy", nullptr}};
      const auto usual = std::max_element(shifts[a].begin(), shifts[a].end(),
                                          [](const auto& x, const auto& y) { return x.second < y.second; });
      if (usual != shifts[a].end() && usual->first != std::pair{0, 0}) {
        action["dx"] = usual->first.first;
        action["dy"] = usual->first.second;
      }
      list.push_back(std::move(action));
    }
    return list;
  }

  void collect_stations() {
    for (StateIndex s{0}; s.value() < num_states_; ++s) {
      for (const auto& cell : map_->state(world_, s).stations) {
        if (std::find(stations_.begin(), stations_.end(), cell) == stations_.end()) stations_.push_back(cell);
      }
    }
    std::sort(stations_.begin(), stations_.end(), [](const Cell& a, const Cell& b) {
      return std::pair{-a.y, a.x} < std::pair{-b.y, b.x};
    });
  }

  [[nodiscard]] Json frame(StateIndex s) const {
    if (!map_) return {{"state", domain_.state_name(world_, s)}};
    const auto state = map_->state(world_, s);
    Json items = Json::array(), stations = Json::array();
    for (std::size_t i = 0; i < state.items.size(); ++i) {
      auto item = position(state.items[i]);
      item.push_back(state.carried[i] ? 1 : 0);
      items.push_back(std::move(item));
    }
    for (const auto& cell : state.stations) {
      stations.push_back(std::find(stations_.begin(), stations_.end(), cell) - stations_.begin());
    }
    auto frame = position(state.robot);
    frame.push_back(std::move(items));
    frame.push_back(std::move(stations));
    return frame;
  }

  [[nodiscard]] Json moves(StateIndex s) const {
    Json row = Json::array();
    for (std::size_t a = 0; a < mdp_.num_actions(); ++a) row.push_back(-1);
    if (mdp_.is_terminal(s)) return row;
    for (const auto& choice : mdp_.choices(s)) row[choice.action.value()] = likeliest(mdp_, s, choice).next.value();
    return row;
  }

  const LiveStudy& study_;
  const Domain& domain_;
  MdpIndex world_;
  const Mdp& mdp_;
  std::optional<GridMap> map_;
  std::size_t num_states_;
  std::vector<Cell> stations_;
};

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

std::size_t max_answer_actions(const Domain& domain) {
  constexpr std::size_t kMost = 500;  // so that an answer with its key presses fits into a message
  return std::min(kMost, domain.max_steps());
}

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

Json world_json(const LiveStudy& study, MdpIndex world) { return WorldTable{study, world}.json(); }

std::optional<std::size_t> world_state(const LiveStudy& study, MdpIndex world, StateIndex state) {
  const auto& mdp = study.atlas->domain().mdp(world);
  if (state.value() >= mdp.num_states() + mdp.num_terminals()) return std::nullopt;
  return state.value();
}

JudgedPath judged_path(const Atlas& atlas, DemoIndex test, std::span<const std::size_t> actions, bool for_ever) {
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
    judged.path.states.push_back(likeliest(mdp, here, *choice).next);
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
      counts += mdp.integer_features(likeliest(mdp, judged.path.states[t],
                                               *choice_of(mdp, judged.path.states[t], judged.path.actions[t].value())));
    }
    judged.counts = counts;
  } else {
    judged.counts = ExpectedCounts{atlas, world, judged.path}.counts();
  }
  return judged;
}

std::optional<Trajectory> answerable_path(const Atlas& atlas, DemoIndex test) {
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
    path.states.push_back(likeliest(mdp, here, *choice_of(mdp, here, path.actions.back().value())).next);
  }
  return path;
}

Trajectory expected_path(const Atlas& atlas, DemoIndex test) {
  auto path = answerable_path(atlas, test);
  return path ? *std::move(path) : atlas.trajectory(test);
}

}  // namespace kith
