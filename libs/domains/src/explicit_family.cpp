// From what model files say to MDPs.
#include "explicit_family.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace kith::detail {
namespace {

// Planners print probabilities with few digits. Sums that are that close to 1 are scaled to 1.
constexpr double kSumSlack = 1e-6;
constexpr std::uint32_t kNone = 0xFFFFFFFFU;

// Consecutive transitions that are the outcomes of one action in one state.
struct RawChoice {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

// Makes one MDP of the model.
class MemberBuilder {
 public:
  MemberBuilder(RawModel& model, RawMdp& raw, Names& keys, std::size_t num_features, double discount,
                ModelReport& report)
      : model_{model}, raw_{raw}, keys_{keys}, num_features_{num_features}, discount_{discount}, report_{report} {}

  std::optional<ExplicitMember> build() {
    const std::size_t before = report_.num_errors();
    check_states();
    collect_choices();
    if (report_.num_errors() > before) return std::nullopt;
    find_live_states();
    note_dead_ends();
    find_reachable_states();
    if (!check_starts() || report_.num_errors() > before) return std::nullopt;
    find_starts();
    return member();
  }

 private:
  [[nodiscard]] ModelPlace place(std::uint32_t offset) const { return place_at(*raw_.file, offset); }
  [[nodiscard]] std::string in_mdp() const { return raw_.name.empty() ? "" : " of MDP '" + raw_.name + "'"; }
  [[nodiscard]] const RawState& state(std::size_t s) const { return raw_.states[s]; }

  void check_states() {
    has_starts_ = std::any_of(raw_.states.begin(), raw_.states.end(), [](const RawState& s) { return s.start; });
    bool ends = false;
    for (const RawState& one : raw_.states) {
      ends = ends || one.terminal;
      if (one.terminal && one.start) {
        report_.error("E0258", one.place, "terminal state '" + one.key + "' cannot be a start",
                      "a terminal state has no actions");
      }
    }
    if (!ends) {
      report_.error("E0256", raw_.place, "there is no terminal state" + (raw_.name.empty() ? "" : in_mdp()),
                    "mark the states that end an episode; a demonstration has to end");
    }
  }

  // Groups the transitions, in the order of states and actions, and checks each group.
  void collect_choices() {
    auto& all = raw_.transitions;
    std::stable_sort(all.begin(), all.end(), [](const RawTransition& a, const RawTransition& b) {
      return std::tie(a.state, a.action, a.next, a.features) < std::tie(b.state, b.action, b.next, b.features);
    });
    first_choice_.assign(raw_.states.size() + 1, 0);
    std::vector<bool> has_rows(raw_.states.size(), false);
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i;
      while (end < all.size() && all[end].state == all[i].state && all[end].action == all[i].action) ++end;
      has_rows[all[i].state] = true;
      add_choice({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - i)});
      i = end;
    }
    for (std::size_t s = 0; s < raw_.states.size(); ++s) {
      first_choice_[s + 1] += first_choice_[s];
      if (has_rows[s] || state(s).terminal) continue;
      report_.error("E0255", state(s).place,
                    "state '" + state(s).key + "'" + in_mdp() + " is not terminal, but has no transition",
                    "mark it as terminal, or add a transition from it");
    }
  }

  void add_choice(RawChoice choice) {
    RawTransition* const outcomes = &raw_.transitions[choice.first];
    const RawState& from = state(outcomes[0].state);
    if (from.terminal) {
      report_.error("E0254", place(outcomes[0].at),
                    "state '" + from.key + "' is terminal, so nothing happens there any more",
                    "remove its transitions, or do not mark it as terminal");
      return;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < choice.count; ++i) {
      if (!check_outcome(outcomes, i)) return;
      sum += outcomes[i].probability;
    }
    if (std::abs(sum - 1.0) > kSumSlack) {
      std::string text = std::to_string(sum);
      report_.error(
          "E0248", place(outcomes[0].probability_at),
          "the probabilities of action '" + model_.actions.all()[outcomes[0].action] + "' in state '" + from.key +
              "' sum to " + text + ", not 1",
          choice.count == 1 ? "are outcomes missing?" : "there are " + std::to_string(choice.count) + " outcomes");
      return;
    }
    for (std::size_t i = 0; i < choice.count; ++i) outcomes[i].probability /= sum;
    // What surely changes nothing is nothing to choose.
    const bool changes =
        std::any_of(outcomes, outcomes + choice.count, [](const RawTransition& one) { return one.next != one.state; });
    if (!changes) return;
    ++first_choice_[outcomes[0].state + 1];
    choices_.push_back(choice);
  }

  bool check_outcome(const RawTransition* outcomes, std::size_t i) {
    const RawTransition& one = outcomes[i];
    if (!(one.probability > 0.0 && one.probability <= 1.0 + kSumSlack)) {
      report_.error("E0247", place(one.probability_at), "a probability must be above 0 and at most 1",
                    "leave out impossible outcomes");
      return false;
    }
    const bool again = i > 0 && outcomes[i - 1].next == one.next && outcomes[i - 1].features == one.features;
    if (!again) return true;
    report_.error("E0246", place(one.at),
                  "state '" + state(one.state).key + "', action '" + model_.actions.all()[one.action] +
                      "' and next state '" + state(one.next).key + "' are given twice",
                  "write one transition with the sum of the probabilities");
    return false;
  }

  // Whether the choice leads to no state that is left out. Known once the live states are.
  [[nodiscard]] bool is_safe(std::uint32_t choice) const { return safe_[choice]; }
  [[nodiscard]] std::uint32_t from(std::uint32_t choice) const {
    return raw_.transitions[choices_[choice].first].state;
  }

  // live_: the states from which an end can surely be reached, by actions that never leave these states. The largest
  // such set, found from above: of what is left, those that can reach an end; until that is all.
  void find_live_states() {
    const std::size_t n = raw_.states.size();
    live_.assign(n, false);
    for (std::size_t s = 0; s < n; ++s) live_[s] = !state(s).terminal;
    safe_.assign(choices_.size(), true);
    std::vector<std::vector<std::uint32_t>> into(n);  // the choices that a state can be the outcome of
    for (std::uint32_t c = 0; c < choices_.size(); ++c) {
      for (std::uint32_t i = 0; i < choices_[c].count; ++i) {
        into[raw_.transitions[choices_[c].first + i].next].push_back(c);
      }
    }
    for (bool again = true; again;) {
      const std::vector<bool> reaches = states_that_reach_an_end(into);
      std::vector<std::uint32_t> dead;
      for (std::uint32_t s = 0; s < n; ++s) {
        if (live_[s] && !reaches[s]) dead.push_back(s);
      }
      again = !dead.empty();
      remove(std::move(dead), into);
    }
  }

  [[nodiscard]] std::vector<bool> states_that_reach_an_end(const std::vector<std::vector<std::uint32_t>>& into) const {
    std::vector<bool> reaches(raw_.states.size(), false);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t s = 0; s < reaches.size(); ++s) {
      if (state(s).terminal) queue.push_back(s);
    }
    while (!queue.empty()) {
      const std::uint32_t next = queue.back();
      queue.pop_back();
      for (const std::uint32_t c : into[next]) {
        if (!safe_[c] || reaches[from(c)]) continue;
        reaches[from(c)] = true;
        queue.push_back(from(c));
      }
    }
    return reaches;
  }

  // Takes these states out, every choice that may lead to them, and every state that has no choice left.
  void remove(std::vector<std::uint32_t> dead, const std::vector<std::vector<std::uint32_t>>& into) {
    while (!dead.empty()) {
      const std::uint32_t s = dead.back();
      dead.pop_back();
      if (!live_[s]) continue;
      live_[s] = false;
      for (const std::uint32_t c : into[s]) {
        if (!safe_[c]) continue;
        safe_[c] = false;
        const auto begin = safe_.begin() + first_choice_[from(c)];
        const auto end = safe_.begin() + first_choice_[from(c) + 1];
        if (std::find(begin, end, true) == end) dead.push_back(from(c));
      }
    }
  }

  void note_dead_ends() {
    std::size_t count = 0;
    const RawState* first = nullptr;
    for (std::size_t s = 0; s < raw_.states.size(); ++s) {
      if (live_[s] || state(s).terminal) continue;
      first = first == nullptr ? &state(s) : first;
      ++count;
    }
    if (count == 0) return;
    report_.warning("W0205", first->place,
                    "left out " + std::to_string(count) + (count == 1 ? " state" : " states") + in_mdp() +
                        " from which an end cannot be reached with certainty, with all actions that may lead there",
                    "the first is '" + first->key + "'; if the robot stays there for ever, mark it as terminal");
  }

  // kept_: what can be reached from the starts, if there are any; else everything.
  void find_reachable_states() {
    const std::size_t n = raw_.states.size();
    std::vector<std::uint32_t> queue;
    for (std::uint32_t s = 0; s < n; ++s) {
      if (live_[s] && (state(s).start || state(s).initial)) queue.push_back(s);
    }

    const bool has_roots =
        std::any_of(raw_.states.begin(), raw_.states.end(), [](const RawState& s) { return s.start || s.initial; });
    kept_.assign(n, !has_roots);
    for (const std::uint32_t s : queue) kept_[s] = true;

    while (!queue.empty()) {
      const std::uint32_t s = queue.back();
      queue.pop_back();
      for (std::uint32_t c = first_choice_[s]; c < first_choice_[s + 1]; ++c) {
        if (!is_safe(c)) continue;
        for (std::uint32_t i = 0; i < choices_[c].count; ++i) {
          const std::uint32_t next = raw_.transitions[choices_[c].first + i].next;
          if (kept_[next]) continue;
          kept_[next] = true;
          if (live_[next]) queue.push_back(next);
        }
      }
    }

    std::size_t count = 0;
    const RawState* first = nullptr;
    for (std::size_t s = 0; s < n; ++s) {
      if (kept_[s] || (!live_[s] && !state(s).terminal)) continue;
      first = first == nullptr ? &state(s) : first;
      ++count;
    }
    if (count > 0) {
      report_.warning("W0204", first->place,
                      "left out " + std::to_string(count) + (count == 1 ? " state" : " states") + in_mdp() +
                          " that cannot be reached from a start",
                      "the first is '" + first->key + "'");
    }
  }

  bool check_starts() {
    for (const RawState& one : raw_.states) {
      const auto s = static_cast<std::size_t>(&one - raw_.states.data());
      if (!(one.start || one.initial) || live_[s]) continue;
      report_.infeasible("E0260", one.place,
                         "from the start '" + one.key + "'" + in_mdp() + " an end cannot be reached with certainty",
                         "mark the states that end an episode as terminal, or start elsewhere");
      return false;
    }
    for (std::size_t s = 0; s < raw_.states.size(); ++s) {
      if (live_[s] && kept_[s]) return true;
    }
    report_.infeasible("E0260", raw_.place, "no state" + in_mdp() + " can reach an end with certainty",
                       "mark the states that end an episode as terminal");
    return false;
  }

  // visit(state, another state that it leads to).
  template <typename Visit>
  void for_each_step(Visit visit) const {
    for (std::uint32_t c = 0; c < choices_.size(); ++c) {
      if (!kept_[from(c)] || !live_[from(c)] || !is_safe(c)) continue;
      for (std::uint32_t i = 0; i < choices_[c].count; ++i) {
        const RawTransition& one = raw_.transitions[choices_[c].first + i];
        if (one.next != one.state) visit(one.state, one.next);
      }
    }
  }

  // is_start_: the states that are declared; if none is, those that others lead to, where a robot enters, and those
  // without which it would never come to one of these. A table may have rows for states in which the robot never is.
  void find_starts() {
    const std::size_t n = raw_.states.size();
    std::vector<bool> is_entered(n, false), is_met(n, false);  // from any state; from one that is entered itself
    for_each_step([&](std::uint32_t, std::uint32_t next) { is_entered[next] = true; });
    for_each_step([&](std::uint32_t s, std::uint32_t next) { is_met[next] = is_met[next] || is_entered[s]; });
    for_each_step([&](std::uint32_t s, std::uint32_t next) {
      if (!is_met[next] && !state(next).terminal) is_entered[s] = true;
    });

    is_start_.assign(n, false);
    bool has_any = false;
    std::vector<std::uint32_t> apart;
    for (std::uint32_t s = 0; s < n; ++s) {
      if (!live_[s] || !kept_[s]) continue;
      is_start_[s] = state(s).start || state(s).initial || (!has_starts_ && is_entered[s]);
      has_any = has_any || is_start_[s];
      if (!is_start_[s] && !has_starts_) apart.push_back(s);
    }

    if (apart.empty()) return;
    if (has_any) return note_apart(apart);
    for (const std::uint32_t s : apart) is_start_[s] = true;
  }

  void note_apart(const std::vector<std::uint32_t>& apart) {
    constexpr std::size_t kMostNamed = 5;
    std::string named;
    for (std::size_t i = 0; i < std::min(apart.size(), kMostNamed); ++i) {
      named += (i == 0 ? "'" : ", '") + state(apart[i]).key + "'";
    }
    report_.warning("W0211", state(apart.front()).place,
                    "no other state" + in_mdp() + " leads to " + std::to_string(apart.size()) +
                        (apart.size() == 1 ? " state" : " states") + ", so nothing is asked or shown from there: " +
                        named + (apart.size() > kMostNamed ? ", ..." : ""),
                    "mark where the robot can begin: a column start or initial");
  }

  // Numbers the states: live ones first, then terminal ones, each in the order of the file.
  ExplicitMember member() {
    const std::size_t n = raw_.states.size();
    std::vector<std::uint32_t> number(n, kNone);
    std::vector<std::uint32_t> order;
    for (const bool terminal : {false, true}) {
      for (std::uint32_t s = 0; s < n; ++s) {
        if (state(s).terminal != terminal || !kept_[s] || (!terminal && !live_[s])) continue;
        number[s] = static_cast<std::uint32_t>(order.size());
        order.push_back(s);
      }
    }

    const auto num_states = static_cast<std::size_t>(
        std::count_if(order.begin(), order.end(), [&](std::uint32_t s) { return !state(s).terminal; }));
    MdpBuilder builder{num_states, order.size() - num_states, model_.actions.size(), num_features_, discount_};

    std::vector<MdpBuilder::Transition> outcomes;
    for (std::size_t i = 0; i < num_states; ++i) {
      for (std::uint32_t c = first_choice_[order[i]]; c < first_choice_[order[i] + 1]; ++c) {
        if (!is_safe(c)) continue;
        outcomes.clear();
        for (std::uint32_t k = 0; k < choices_[c].count; ++k) {
          const RawTransition& one = raw_.transitions[choices_[c].first + k];
          outcomes.push_back({StateIndex{number[one.next]}, one.probability, model_.features.row(one.features)});
        }
        builder.add_choice(StateIndex{i}, ActionIndex{raw_.transitions[choices_[c].first].action}, outcomes);
      }
    }

    ExplicitMember result{raw_.name, std::move(builder).build(), {}, StateIndex{0}, {}, {}, {}};
    describe(result, order, num_states);
    return result;
  }

  void describe(ExplicitMember& result, const std::vector<std::uint32_t>& order, std::size_t num_states) {
    const std::size_t num_variables = model_.variables.size();
    std::optional<std::size_t> initial;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const RawState& one = state(order[i]);
      result.names.push_back(name_of(order[i]));
      result.keys.push_back(keys_.number_of(one.key));
      const auto begin = raw_.variables.begin() + static_cast<std::ptrdiff_t>(order[i] * num_variables);
      if (!raw_.variables.empty()) {
        result.variables.insert(result.variables.end(), begin, begin + static_cast<std::ptrdiff_t>(num_variables));
      }
      if (i >= num_states) continue;
      if (is_start_[order[i]]) result.starts.emplace_back(i);
      if (one.initial && !initial) initial = i;
    }
    result.initial = initial ? StateIndex{*initial} : result.starts.front();
  }

  // What the file calls it; else its values; else its number or key.
  [[nodiscard]] std::string name_of(std::uint32_t s) const {
    const RawState& one = state(s);
    if (!one.name.empty()) return one.name;
    const bool is_number = !one.key.empty() && one.key.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number) return one.key;
    std::string values;
    for (std::size_t v = 0; v < model_.variables.size(); ++v) {
      values += (v == 0 ? "" : ", ") + model_.variables[v] + " " +
                std::to_string(raw_.variables[s * model_.variables.size() + v]);
    }
    return values.empty() ? "state " + one.key : values;
  }

  RawModel& model_;
  RawMdp& raw_;
  Names& keys_;
  std::size_t num_features_;
  double discount_;
  ModelReport& report_;
  bool has_starts_ = false;
  std::vector<RawChoice> choices_;
  std::vector<std::uint32_t> first_choice_;  // shape [states + 1]
  std::vector<bool> live_;
  std::vector<bool> safe_;  // per choice
  std::vector<bool> kept_;
  std::vector<bool> is_start_;
};

}  // namespace

ExplicitFamily build_explicit_family(RawModel&& model, std::size_t num_features, double discount,
                                     const DomainLimits& limits, ModelReport& report) {
  ExplicitFamily family;
  family.variables = model.variables;
  std::size_t num_states = 0;
  for (const RawMdp& mdp : model.mdps) num_states += mdp.states.size();
  if (model.mdps.empty() || num_states > limits.max_states) {
    const ModelPlace place = model.mdps.empty() ? ModelPlace{model.last_file} : model.mdps.front().place;
    report.error("E0257", place,
                 model.mdps.empty() ? "there is no MDP"
                                    : "the model has " + std::to_string(num_states) + " states; at most " +
                                          std::to_string(limits.max_states) + " are built",
                 model.mdps.empty() ? "a model has at least one" : "leave out what the robot cannot reach");
    return family;
  }
  Names keys;
  for (RawMdp& raw : model.mdps) {
    auto member = MemberBuilder{model, raw, keys, num_features, discount, report}.build();
    if (member) family.members.push_back(*std::move(member));
    for (const RawState& one : raw.states) (void)keys.number_of(one.key);
    raw = {};  // as much memory as the MDP takes
    if (report.is_full()) break;
  }
  family.keys = keys.all();
  return family;
}

}  // namespace kith::detail
