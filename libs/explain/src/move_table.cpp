#include "kith/explain/move_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kith/core/assert.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

std::string utf8(char32_t c) {
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xc0 | (c >> 6)), static_cast<char>(0x80 | (c & 0x3f))};
  KITH_ASSERT(c < 0xd800);  // a world has no more states than that, and few kinds of steps
  return {static_cast<char>(0xe0 | (c >> 12)), static_cast<char>(0x80 | ((c >> 6) & 0x3f)),
          static_cast<char>(0x80 | (c & 0x3f))};
}

// Columns to the right and rows down.
using Shift = std::pair<int, int>;

std::optional<Shift> direction_called(std::string_view name) {
  if (name == "up") return Shift{0, -1};
  if (name == "down") return Shift{0, 1};
  if (name == "left") return Shift{-1, 0};
  if (name == "right") return Shift{1, 0};
  return std::nullopt;
}

class MoveTable {
 public:
  MoveTable(const Domain& domain, MdpIndex world)
      : domain_{domain},
        world_{world},
        mdp_{domain_.mdp(world)},
        map_{domain_.drawing()},
        num_states_{mdp_.num_states() + mdp_.num_terminals()} {}

  [[nodiscard]] Json json() {
    Json table{{"actions", actions()}};
    if (map_) {
      collect_stations();
      Json items = Json::array();
      for (const auto i : map_->items_in(world_)) items.push_back(map_->item_names()[i]);
      Json stations = Json::array();
      for (const auto& cell : stations_) stations.push_back(position(cell));
      table["items"] = std::move(items);
      table["stations"] = std::move(stations);
    }

    Json frames = Json::array(), next = Json::array(), end = Json::array(), counts = Json::array();
    for (StateIndex s{0}; s.value() < num_states_; ++s) {
      frames.push_back(frame(s));
      next.push_back(moves(s));
      counts.push_back(kinds_of(s));
      end.push_back(mdp_.is_terminal(s));
    }

    table["frames"] = std::move(frames);
    table["next"] = std::move(next);
    table["end"] = std::move(end);
    table["counts"] = std::move(counts);
    table["kinds"] = std::move(kinds_);
    table["chance"] = !mdp_.is_deterministic();
    table["may_repeat"] = mdp_.discount() < 1.0;
    return table;
  }

 private:
  // What each action counts, as positions in `kinds`: a character each.
  [[nodiscard]] std::string kinds_of(StateIndex s) {
    constexpr char32_t kFirst = U'0';
    std::vector<std::string> row(mdp_.num_actions(), "-");
    if (mdp_.is_terminal(s)) return "";
    for (const auto& choice : mdp_.choices(s)) {
      const auto kind = number_of(counts_json(mdp_, likeliest_outcome(mdp_, s, choice)));
      row[choice.action.value()] = utf8(kFirst + static_cast<char32_t>(kind));
    }
    std::string text;
    for (const auto& word : row) text += word;
    return text;
  }
  [[nodiscard]] std::size_t number_of(Json counts) {
    const auto at = std::find(kinds_.begin(), kinds_.end(), counts);
    if (at != kinds_.end()) return static_cast<std::size_t>(at - kinds_.begin());
    kinds_.push_back(std::move(counts));
    return kinds_.size() - 1;
  }

  // Column and row from the top left, from 1.
  [[nodiscard]] Json position(const Cell& cell) const { return Json::array({cell.x, map_->height() + 1 - cell.y}); }

  // Where an action moves the robot most often, if it moves it at all. On ice all directions may be as likely: then it
  // is the name that says which one is meant.
  [[nodiscard]] Json actions() const {
    std::vector<std::map<Shift, std::size_t>> shifts(mdp_.num_actions());
    for (StateIndex s{0}; map_ && s.value() < mdp_.num_states(); ++s) {
      const auto from = map_->state(world_, s);
      for (const auto& choice : mdp_.choices(s)) {
        const auto& usual = likeliest_outcome(mdp_, s, choice);
        for (const auto& outcome : mdp_.outcomes(choice)) {
          const auto to = map_->state(world_, outcome.next);
          if (to.exited || outcome.probability < usual.probability) continue;
          ++shifts[choice.action.value()][{to.robot.x - from.robot.x, from.robot.y - to.robot.y}];
        }
      }
    }

    Json list = Json::array();
    for (std::size_t a = 0; a < mdp_.num_actions(); ++a) {
      const auto& name = domain_.action_names()[a];
      auto label = action_infinitive(name);
      if (label == "do '" + name + "'") label = name;
      Json action{{"name", name}, {"label", label}, {"dx", nullptr}, {"dy", nullptr}};

      // Where the name says a direction and the robot can go there, that is meant; else what it usually does.
      const auto usual = std::max_element(shifts[a].begin(), shifts[a].end(),
                                          [](const auto& x, const auto& y) { return x.second < y.second; });
      const auto meant = direction_called(name);
      if (meant && shifts[a].contains(*meant)) {
        action["dx"] = meant->first;
        action["dy"] = meant->second;
      } else if (usual != shifts[a].end() && usual->first != Shift{0, 0}) {
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
    for (const auto& choice : mdp_.choices(s))
      row[choice.action.value()] = likeliest_outcome(mdp_, s, choice).next.value();
    return row;
  }

  const Domain& domain_;
  MdpIndex world_;
  const Mdp& mdp_;
  std::optional<GridMap> map_;
  std::size_t num_states_;
  std::vector<Cell> stations_;
  Json kinds_ = Json::array();
};

// Everything that can follow, of every state that does not end and every action.
Json outcomes_json(const Mdp& mdp) {
  Json outcomes = Json::array();
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    Json row = Json::array();
    for (std::size_t a = 0; a < mdp.num_actions(); ++a) row.push_back(nullptr);
    for (const auto& choice : mdp.choices(s)) {
      Json all = Json::array();
      for (const auto& outcome : mdp.outcomes(choice)) {
        all.push_back({outcome.next.value(), outcome.probability, counts_json(mdp, outcome)});
      }
      row[choice.action.value()] = std::move(all);
    }
    outcomes.push_back(std::move(row));
  }
  return outcomes;
}

// Of a world in which a path is worth what is to be expected: what the robot does, and what it counts from every state
// on.
Json expectations_json(const Atlas& atlas, MdpIndex world) {
  const auto& mdp = atlas.domain().mdp(world);
  Json robot = Json::array(), ahead = Json::array();
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    const auto start = atlas.index({world, s});
    robot.push_back(atlas.action(start).value());
    const auto& counts = atlas.feature_counts(start);
    ahead.push_back(std::vector<std::int64_t>(counts.begin(), counts.end()));
  }
  return {{"outcomes", outcomes_json(mdp)}, {"robot", robot}, {"ahead", ahead}};
}

}  // namespace

const Outcome& likeliest_outcome(const Mdp& mdp, StateIndex s, const Choice& choice) {
  const auto outcomes = mdp.outcomes(choice);
  return *std::max_element(outcomes.begin(), outcomes.end(), [&](const Outcome& a, const Outcome& b) {
    const double of_a = a.next == s ? 0.0 : a.probability;
    const double of_b = b.next == s ? 0.0 : b.probability;
    return of_a < of_b;
  });
}

Json counts_json(const Mdp& mdp, const Outcome& outcome) {
  Json counts = Json::array();
  for (const double x : mdp.features(outcome)) {
    if (x == std::trunc(x))
      counts.push_back(static_cast<std::int64_t>(x));
    else
      counts.push_back(x);
  }
  return counts;
}

std::size_t max_answer_actions(const Domain& domain) {
  constexpr std::size_t kMost = 500;  // so that an answer with its key presses fits into a message
  return std::min(kMost, domain.max_steps());
}

Json move_table_json(const Domain& domain, MdpIndex world) {
  auto table = MoveTable{domain, world}.json();
  const auto& mdp = domain.mdp(world);
  if (!mdp.is_deterministic()) table["outcomes"] = outcomes_json(mdp);
  return table;
}

Json judged_table_json(const Atlas& atlas, MdpIndex world) {
  auto table = move_table_json(atlas.domain(), world);
  if (!atlas.domain().is_exact()) table.update(expectations_json(atlas, world));
  return table;
}

Json judge_json(const Domain& domain) {
  const auto& weights = domain.weights();
  Json integer = Json::array(), unit = Json::array();
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    integer.push_back(std::to_string(weights.integer[k]));  // beyond what a page can read as a number
    unit.push_back(weights.unit[static_cast<Eigen::Index>(k)]);
  }
  return {{"exact", domain.is_exact()},
          {"weights", integer},
          {"unit", unit},
          {"scale", domain.count_scale()},
          {"discount", domain.mdp(MdpIndex{0}).discount()}};
}

}  // namespace kith
