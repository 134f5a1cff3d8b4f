// Gymnasium's transition tables: P[s][a] = [[probability, next state, reward, terminated], ...] as JSON.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "kith/models/json_tree.hpp"
#include "kith/models/model_formats.hpp"

namespace kith::detail {
namespace {

using Kind = JsonTree::Kind;
using Value = JsonTree::Value;

// One entry of a list P[s][a].
struct GymOutcome {
  std::uint32_t state = 0;
  std::uint32_t action = 0;  // in the numbers of the file
  std::uint32_t next = 0;
  std::uint32_t features = 0;
  double probability = 0.0;
  bool terminated = false;
  ModelPlace place;
  ModelPlace probability_place;
};

class GymReader {
 public:
  GymReader(const ModelText& file, const std::string& name, std::optional<std::uint32_t> initial,
            const std::vector<std::string>& features, RawModel& model, ModelReport& report)
      : file_{file}, initial_{initial}, features_{features}, model_{model}, report_{report} {
    mdp_.name = name;
    mdp_.file = &file;
    mdp_.place = {&file};
  }

  std::optional<GymRewards> read() {
    const auto tree = JsonTree::parse(file_, report_);
    if (!tree) return std::nullopt;
    const Value root = tree->root();
    auto table = root.find("P");
    if (!table) table = root;  // the table alone
    const auto phi = root.find("phi");
    if (phi) rewards_ = GymRewards::kVectors;
    num_states_ = check_numbering(*table, "P");
    if (report_.has_errors()) return std::nullopt;
    for_each_entry(*table, kState, [&](std::uint32_t s, const Value& actions) {
      for_each_entry(actions, kAction, [&](std::uint32_t a, const Value& list) { read_list(s, a, list); });
    });
    if (phi && !report_.has_errors()) read_phi(*phi);
    if (!report_.has_errors()) make_states();
    read_names(root);
    if (report_.has_errors()) return std::nullopt;
    make_transitions(root);
    if (report_.has_errors()) return std::nullopt;
    model_.mdps.push_back(std::move(mdp_));
    return rewards_.value_or(GymRewards::kNumbers);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // What the numbers of a table count, and the error if one of them occurs twice.
  struct Numbered {
    const char* what;
    const char* twice;
  };
  static constexpr Numbered kState{"state", "E0241"}, kAction{"action", "E0238"};

  void malformed(const ModelPlace& place, const std::string& message, const std::string& hint) {
    report_.error("E0235", place, message, hint);
  }

  static std::optional<std::uint32_t> index_from(std::string_view text) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && !text.empty() ? std::optional{value}
                                                                                     : std::nullopt;
  }

  // Visits the entries of a list, or of an object whose keys are numbers, no two alike: "0" and "00" are.
  template <typename Visit>
  void for_each_entry(const Value& table, const Numbered& numbered, const Visit& visit) {
    if (table.is(Kind::kList)) {
      std::uint32_t index = 0;
      table.for_each_element([&](const Value& one) { visit(index++, one); });
      return;
    }
    if (!table.is(Kind::kObject)) {
      return malformed(table.place(), "expected a list or an object, not " + std::string{table.kind_name()},
                       "P[s][a] is a list of [probability, next state, reward, terminated]");
    }

    std::unordered_map<std::uint32_t, Value> seen;
    table.for_each_member([&](const Value& key, const Value& value) {
      if (report_.is_full()) return;
      const auto index = index_from(key.string());
      if (!index) {
        return malformed(key.place(), "expected a number as key, not \"" + key.string() + "\"",
                         "states and actions are numbered from 0");
      }

      // "1" and "01" are two keys and one number.
      const auto [known, is_new] = seen.try_emplace(*index, key);
      if (is_new) return visit(*index, value);
      report_.error(numbered.twice, key.place(),
                    std::string{numbered.what} + " " + std::to_string(*index) + " is given twice, as \"" +
                        known->second.string() + "\" and as \"" + key.string() + "\"",
                    "write numbers without zeros in front, each of them once");
    });
  }

  // The number of states, which must be numbered without gaps.
  std::uint32_t check_numbering(const Value& table, const std::string& what) {
    std::size_t count = 0;
    std::uint32_t largest = 0;
    for_each_entry(table, kState, [&](std::uint32_t s, const Value&) {
      ++count;
      largest = std::max(largest, s);
    });
    if (report_.has_errors()) return 0;
    if (count == 0 || count > kMaxModelStates) {
      report_.error("E0257", table.place(), what + " must have 1 to " + std::to_string(kMaxModelStates) + " states",
                    "leave out what the robot cannot reach");
    } else if (largest + std::size_t{1} != count) {
      report_.error("E0237", table.place(),
                    "there are " + std::to_string(count) + " states, but one is number " + std::to_string(largest),
                    "states are numbered 0, 1, 2, ... without gaps");
    }
    return static_cast<std::uint32_t>(count);
  }

  void read_list(std::uint32_t s, std::uint32_t a, const Value& list) {
    if (!list.is(Kind::kList)) {
      return malformed(list.place(), "P[s][a] must be a list, not " + std::string{list.kind_name()},
                       "write [[probability, next state, reward, terminated], ...]");
    }
    if (a >= kMaxModelActions) {
      return report_.error("E0257", list.place(),
                           "there are more than " + std::to_string(kMaxModelActions) + " actions",
                           "actions are numbered 0, 1, 2, ...");
    }
    list.for_each_element([&](const Value& one) {
      if (!report_.is_full() && has_room(model_, one.place(), report_)) read_outcome(s, a, one);
    });
  }

  void read_outcome(std::uint32_t s, std::uint32_t a, const Value& value) {
    std::vector<Value> parts;
    value.for_each_element([&](const Value& part) { parts.push_back(part); });
    const bool sound = parts.size() == 4 && parts[0].is(Kind::kNumber) && parts[1].is(Kind::kNumber) &&
                       (parts[2].is(Kind::kNumber) || parts[2].is(Kind::kList)) && parts[3].is(Kind::kBoolean);
    if (!sound) {
      return malformed(value.place(), "an outcome must be [probability, next state, reward, terminated]",
                       "for instance [0.8, 3, -1.0, false]; the reward may be a list, a number per feature");
    }

    GymOutcome outcome;
    outcome.state = s;
    outcome.action = a;
    outcome.place = value.place();
    outcome.probability = parts[0].number();
    outcome.probability_place = parts[0].place();
    outcome.terminated = parts[3].boolean();

    const double next = parts[1].number();
    if (next != std::floor(next) || next < 0.0 || next >= num_states_) {
      return report_.error("E0240", parts[1].place(), "there is no such state",
                           "states are numbered 0 to " + std::to_string(num_states_ - 1));
    }
    outcome.next = static_cast<std::uint32_t>(next);

    const auto row = reward_row(parts[2]);
    if (!row) return;
    outcome.features = *row;
    outcomes_.push_back(outcome);
    ++model_.num_transitions;
  }

  // What stands in the place of the reward: features, or one number, which is given up where there is "phi".
  std::optional<std::uint32_t> reward_row(const Value& reward) {
    const bool is_vector = reward.is(Kind::kList);
    if (!is_vector && !check_finite(reward.number(), "a reward", reward.place(), report_)) return std::nullopt;
    if (!rewards_) rewards_ = is_vector ? GymRewards::kVectors : GymRewards::kNumbers;
    if (is_vector) {
      if (rewards_ == GymRewards::kVectors) return vector_row(reward);
      malformed(reward.place(), "this reward is a list, but an earlier one is a number",
                "write all rewards in one way");
      return std::nullopt;
    }
    if (rewards_ == GymRewards::kNumbers) return model_.features.number_of({reward.number()});
    return 0;  // of a table with "phi", which says it later; of one without, every one is a vector
  }

  std::optional<std::uint32_t> vector_row(const Value& list) {
    if (list.size() != features_.size()) {
      report_.error("E0250", list.place(),
                    "there are " + std::to_string(list.size()) + " features, not " + std::to_string(features_.size()),
                    "one number for each [[feature]] of the domain file, in that order");
      return std::nullopt;
    }
    std::vector<double> row;
    bool sound = true;
    list.for_each_element([&](const Value& one) {
      if (!one.is(Kind::kNumber)) {
        sound = false;
        return malformed(one.place(), "a feature must be a number, not " + std::string{one.kind_name()}, "");
      }
      sound = sound && check_finite(one.number(), "a feature", one.place(), report_);
      row.push_back(one.number());
    });
    return sound ? std::optional{model_.features.number_of(row)} : std::nullopt;
  }

  // "phi" has the same shape as P, with a vector in the place of every outcome.
  void read_phi(const Value& phi) {
    std::size_t position = 0;
    for_each_entry(phi, kState, [&](std::uint32_t s, const Value& actions) {
      for_each_entry(actions, kAction, [&](std::uint32_t a, const Value& list) {
        list.for_each_element([&](const Value& vector) {
          const bool fits = position < outcomes_.size() && outcomes_[position].state == s &&
                            outcomes_[position].action == a && vector.is(Kind::kList);
          if (!fits) {
            if (!report_.has_errors())
              malformed(vector.place(), "\"phi\" must have the shape and the order of \"P\"", "a vector per outcome");
            return;
          }
          if (const auto row = vector_row(vector)) outcomes_[position].features = *row;
          ++position;
        });
      });
    });
    if (!report_.has_errors() && position != outcomes_.size()) {
      malformed(phi.place(), "\"phi\" must have the shape and the order of \"P\"", "a vector per outcome");
    }
  }

  // A state that is only ever entered as the end of an episode is terminal. One that is also entered otherwise, or
  // from which something happens that is never the end, is both: it gets a terminal twin.
  void make_states() {
    std::vector<bool> ended(num_states_, false);
    std::vector<bool> entered(num_states_, false);
    std::vector<bool> leaves(num_states_, false);
    for (const GymOutcome& one : outcomes_) {
      if (one.terminated) ended[one.next] = true;
      if (one.next != one.state) leaves[one.state] = true;
      if (!one.terminated && one.next != one.state) entered[one.next] = true;
    }
    alive_.assign(num_states_, kNone);
    end_.assign(num_states_, kNone);
    for (std::uint32_t s = 0; s < num_states_; ++s) {
      const bool is_state = !ended[s] || entered[s];
      const std::string key = std::to_string(s);
      if (is_state) alive_[s] = add_state(key, false);
      if (ended[s]) end_[s] = add_state(is_state ? key + " (end)" : key, true);
    }
  }

  std::uint32_t add_state(const std::string& key, bool terminal) {
    RawState state;
    state.key = key;
    state.terminal = terminal;
    state.place = {&file_};
    mdp_.states.push_back(std::move(state));
    return static_cast<std::uint32_t>(mdp_.states.size() - 1);
  }

  void read_names(const Value& root) {
    if (!root.find("P")) return;
    for_each_text(root, "states", [&](std::uint32_t s, const Value& name) {
      if (s >= num_states_) return malformed(name.place(), "there are more names than states", "");
      if (alive_.empty()) return;
      if (alive_[s] != kNone) mdp_.states[alive_[s]].name = name.string();
      if (end_[s] != kNone) mdp_.states[end_[s]].name = name.string();
    });
    for_each_text(root, "actions", [&](std::uint32_t, const Value& name) {
      if (std::find(action_names_.begin(), action_names_.end(), name.string()) != action_names_.end()) {
        return report_.error("E0222", name.place(), "action '" + name.string() + "' is listed twice",
                             "give every action a name of its own");
      }
      action_names_.push_back(name.string());
      action_places_.push_back(name.place());
    });
    if (const auto features = root.find("features")) check_features(*features);
  }

  template <typename Visit>
  void for_each_text(const Value& root, const char* key, const Visit& visit) {
    const auto list = root.find(key);
    if (!list) return;
    if (!list->is(Kind::kList)) return malformed(list->place(), std::string{"\""} + key + "\" must be a list", "");
    std::uint32_t index = 0;
    list->for_each_element([&](const Value& one) {
      if (!one.is(Kind::kString))
        return malformed(one.place(), std::string{"a name in \""} + key + "\" must be a string", "");
      visit(index++, one);
    });
  }

  // The order of vectors; that of the domain file if it is not said.
  void check_features(const Value& list) {
    if (rewards_ != GymRewards::kVectors) return;
    std::vector<std::string> names;
    list.for_each_element([&](const Value& one) { names.push_back(one.is(Kind::kString) ? one.string() : ""); });
    if (names == features_) return;
    report_.error("E0253", list.place(), "these are not the features of the domain file",
                  "declare them as [[feature]] in this order");
  }

  void make_transitions(const Value& root) {
    for (const GymOutcome& one : outcomes_) {
      const std::uint32_t from = alive_[one.state];
      if (from == kNone) {  // after the end nothing happens
        note_after_end(one);
        continue;
      }
      const auto action = number_of_action(one);
      if (!action) return;
      RawTransition transition;
      transition.state = from;
      transition.action = *action;
      transition.next = one.terminated ? end_[one.next] : alive_[one.next];
      if (transition.next == kNone) transition.next = end_[one.next];  // where nothing but the end was ever entered
      transition.features = one.features;
      transition.probability = one.probability;
      transition.at = static_cast<std::uint32_t>(one.place.offset);
      transition.probability_at = static_cast<std::uint32_t>(one.probability_place.offset);
      mdp_.transitions.push_back(transition);
    }
    merge_equal_outcomes();
    if (initial_ && *initial_ < num_states_ && alive_[*initial_] != kNone) {
      mdp_.states[alive_[*initial_]].initial = true;
    } else if (initial_) {
      report_.error(
          "E0240", {&file_}, "there is no state " + std::to_string(*initial_) + " to begin in",
          "the domain file asks for it as initial; states are numbered 0 to " + std::to_string(num_states_ - 1));
    } else {
      mark(root, "initial");
    }
    mark(root, "starts");
  }

  // Gymnasium's tables often go on there; what never happens is left out, once with a word.
  void note_after_end(const GymOutcome& one) {
    const std::vector<double>& row = model_.features.row(one.features);
    const bool is_plain =
        one.next == one.state && std::all_of(row.begin(), row.end(), [](double x) { return x == 0.0; });
    if (is_plain || noted_) return;
    noted_ = true;
    report_.warning("W0210", one.place,
                    "state " + std::to_string(one.state) + " ends episodes: what happens in it is left out",
                    "it is said for the first such state");
  }

  std::optional<std::uint32_t> number_of_action(const GymOutcome& one) {
    if (one.action < action_names_.size()) {
      return action_number(model_, action_names_[one.action], action_places_[one.action], report_);
    }
    if (model_.actions_are_declared && action_names_.empty()) {
      if (one.action < model_.actions.size()) return one.action;
      report_.error("E0243", one.place,
                    "there is no name for action " + std::to_string(one.action) + " in [mdp] actions",
                    "list all actions, in the order of their numbers");
      return std::nullopt;
    }
    return action_number(model_, "action " + std::to_string(one.action), one.place, report_);
  }

  // Gymnasium's tables list an outcome twice where two things that can happen lead to the same state.
  void merge_equal_outcomes() {
    auto& all = mdp_.transitions;
    const auto same = [](const RawTransition& a, const RawTransition& b) {
      return a.state == b.state && a.action == b.action && a.next == b.next && a.features == b.features;
    };
    std::size_t kept = 0;
    std::size_t first = 0;  // of the outcomes of the same state and action
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i > 0 && (all[i].state != all[i - 1].state || all[i].action != all[i - 1].action)) first = kept;
      const auto at = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first),
                                   all.begin() + static_cast<std::ptrdiff_t>(kept),
                                   [&](const RawTransition& one) { return same(one, all[i]); });
      if (at != all.begin() + static_cast<std::ptrdiff_t>(kept)) {
        at->probability += all[i].probability;
      } else {
        all[kept++] = all[i];
      }
    }
    all.resize(kept);
  }

  // "initial": s; "starts": [s, ...].
  void mark(const Value& root, const char* key) {
    const auto value = root.find("P") ? root.find(key) : std::nullopt;
    if (!value) return;
    const auto mark_one = [&](const Value& one) {
      const double s = one.is(Kind::kNumber) ? one.number() : -1.0;
      if (s < 0.0 || s >= num_states_ || s != std::floor(s)) {
        return report_.error("E0240", one.place(), "there is no such state",
                             "states are numbered 0 to " + std::to_string(num_states_ - 1));
      }
      const auto number = static_cast<std::size_t>(s);
      RawState& state = mdp_.states[alive_[number] != kNone ? alive_[number] : end_[number]];
      (std::string_view{key} == "starts" ? state.start : state.initial) = true;
      state.place = one.place();
    };
    if (value->is(Kind::kList)) {
      value->for_each_element(mark_one);
    } else {
      mark_one(*value);
    }
  }

  const ModelText& file_;
  std::optional<std::uint32_t> initial_;
  const std::vector<std::string>& features_;
  RawModel& model_;
  ModelReport& report_;
  RawMdp mdp_;
  std::optional<GymRewards> rewards_;
  std::uint32_t num_states_ = 0;
  bool noted_ = false;
  std::vector<GymOutcome> outcomes_;
  std::vector<std::uint32_t> alive_;  // per state of the file: its number as a state in which something can be done
  std::vector<std::uint32_t> end_;    // and as the end of an episode
  std::vector<std::string> action_names_;
  std::vector<ModelPlace> action_places_;
};

}  // namespace

std::optional<GymRewards> read_gym_mdp(const ModelText& file, const std::string& name,
                                       std::optional<std::uint32_t> initial, const std::vector<std::string>& features,
                                       RawModel& model, ModelReport& report) {
  model.terminals_may_have_rows = true;
  model.outcomes_may_repeat = true;
  return GymReader{file, name, initial, features, model, report}.read();
}

}  // namespace kith::detail
