#include "kith/domains/policy_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/domains/model_text.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/files/reader.hpp"

namespace kith {
namespace {

using detail::ModelPlace;
using detail::ModelReport;

constexpr double kSumSlack = 1e-6;  // planners print probabilities with few digits

class PolicyReader {
 public:
  PolicyReader(const detail::ModelText& file, const Domain& domain, ModelReport& report)
      : file_{file}, domain_{domain}, report_{report}, states_(domain.num_mdps()) {
    for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
      policy_.probability.emplace_back(domain.mdp(m).num_choices(), 0.0);
      policy_.is_seen.emplace_back(domain.mdp(m).num_states(), false);
      totals_.emplace_back(domain.mdp(m).num_states(), 0.0);
    }
  }

  void read() {
    const auto first = file_.text.find_first_not_of(" \t\r\n");
    const bool is_json = first != std::string::npos && (file_.text[first] == '[' || file_.text[first] == '{');
    if (is_json) {
      return report_.error("E0286", {&file_}, "a policy is a table, not JSON",
                           "python -m kith.convert " + file_.shown + " -o POLICY.csv");
    }
    read_table();
    if (!report_.has_errors()) finish();
  }

  ObservedPolicy take() { return std::move(policy_); }

 private:
  std::optional<MdpIndex> world_called(const std::string& name, const ModelPlace& place) {
    const auto found = domain_.find_world(name);
    if (!found) {
      report_.error(
          "E0281", place, "there is no world '" + name + "'",
          "worlds have numbers from 0 to " + std::to_string(domain_.num_mdps() - 1) + ", and some have names");
    }
    return found;
  }

  // By key and by name; what acts comes before what has ended.
  const std::unordered_map<std::string, StateIndex>& states_of(MdpIndex m) {
    auto& known = states_[m.value()];
    if (!known.empty()) return known;
    const Mdp& mdp = domain_.mdp(m);
    const auto n = mdp.num_states() + mdp.num_terminals();
    for (StateIndex s{0}; s.value() < n; ++s) known.try_emplace(domain_.state_key(m, s), s);
    for (StateIndex s{0}; s.value() < n; ++s) known.try_emplace(domain_.state_name(m, s), s);
    return known;
  }

  // A state in which the robot acts; nothing if it has ended there, or the domain leaves it out.
  std::optional<StateIndex> state_called(MdpIndex m, const std::string& name, const ModelPlace& place) {
    const auto& known = states_of(m);
    if (const auto at = known.find(name); at != known.end())
      return domain_.mdp(m).is_terminal(at->second) ? std::nullopt : std::optional{at->second};
    if (keys_.empty()) keys_.insert(domain_.model_keys().begin(), domain_.model_keys().end());
    if (keys_.contains(name)) return std::nullopt;
    report_.error("E0282", place, "there is no state '" + name + "'",
                  domain_.map() ? "states have numbers from 0, as in tables of runs, and names such as '" +
                                      domain_.state_name(m, StateIndex{0}) + "'"
                                : "the files of the model say what states are called, such as '" +
                                      domain_.state_key(m, StateIndex{0}) + "'");
    return std::nullopt;
  }

  std::optional<ActionIndex> action_called(const std::string& name, const ModelPlace& place) {
    const auto& names = domain_.action_names();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return ActionIndex{static_cast<std::size_t>(at - names.begin())};
    std::size_t number = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (failure == std::errc{} && end == name.data() + name.size() && number < names.size()) return ActionIndex{number};
    report_.error("E0283", place, "there is no action '" + name + "'", suggestion(name, names));
    return std::nullopt;
  }

  void add(MdpIndex m, StateIndex s, ActionIndex action, double weight) {
    policy_.is_seen[m.value()][s.value()] = true;
    totals_[m.value()][s.value()] += weight;
    const Mdp& mdp = domain_.mdp(m);
    const auto choices = mdp.choices(s);
    const auto at =
        std::find_if(choices.begin(), choices.end(), [&](const Choice& one) { return one.action == action; });
    if (at == choices.end()) return;  // it stays where it is, or cannot surely end
    policy_.probability[m.value()][mdp.first_choice(s) + static_cast<std::size_t>(at - choices.begin())] += weight;
  }

  void finish() {
    bool any = false;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      const Mdp& mdp = domain_.mdp(m);
      for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
        if (!policy_.is_seen[m.value()][s.value()]) continue;
        const double total = totals_[m.value()][s.value()];
        any = true;
        if (has_probabilities_ && std::abs(total - 1.0) > kSumSlack) {
          report_.error("E0284", {&file_},
                        "the probabilities in state '" + domain_.state_name(m, s) + "' sum to " +
                            std::to_string(total) + ", not 1",
                        "give every action that the robot may take there");
          if (report_.is_full()) return;
          continue;
        }
        for (std::size_t c = 0; c < mdp.choices(s).size(); ++c)
          policy_.probability[m.value()][mdp.first_choice(s) + c] /= total;
      }
    }
    if (!any) {
      report_.error("E0285", {&file_}, "the policy says nothing about any state in which the robot acts",
                    "write a row for every state: state,action");
    }
  }

  bool check_probability(double probability, const ModelPlace& place) {
    if (probability >= 0.0 && probability <= 1.0 + kSumSlack) return true;
    report_.error("E0284", place, "a probability must be from 0 to 1", "those of a state sum to 1");
    return false;
  }

  void read_table() {
    std::vector<Column> header;
    try {
      header = read_csv_header(file_.text, file_.shown);
    } catch (const Error& error) {
      return report_.take(error.diagnostics());
    }
    const auto has = [&](std::string_view name) {
      return std::any_of(header.begin(), header.end(), [&](const Column& one) { return one.name == name; });
    };
    std::vector<Column> columns{{.name = "state", .type = ColumnType::kText, .required = true},
                                {.name = "action", .type = ColumnType::kText, .required = true}};
    has_probabilities_ = has("probability");
    if (has_probabilities_) columns.push_back({.name = "probability", .type = ColumnType::kReal, .required = true});
    const bool has_world = domain_.num_mdps() > 1 || has("world");
    if (has_world) columns.push_back({.name = "world", .type = ColumnType::kText, .required = true});
    const auto on_row = [&](const CsvRow& row) {
      if (!report_.is_full()) add_row(row, has_world);
    };
    report_.take(read_csv(file_.text, file_.shown, columns, on_row, OtherColumns::kIgnore));
  }

  void add_row(const CsvRow& row, bool has_world) {
    const auto place = [&](std::size_t column) { return place_of(file_, row.written(column)); };
    const auto text = [&](std::size_t column) { return std::get<std::string>(row.cells[column]); };
    const auto last = row.cells.size() - 1;
    const auto m = has_world ? world_called(text(last), place(last)) : std::optional{MdpIndex{0}};
    const auto action = action_called(text(1), place(1));
    const double weight = has_probabilities_ ? std::get<double>(row.cells[2]) : 1.0;
    if (has_probabilities_ && !check_probability(weight, place(2))) return;
    if (!m || !action) return;
    if (const auto s = state_called(*m, text(0), place(0))) add(*m, *s, *action, weight);
  }

  const detail::ModelText& file_;
  const Domain& domain_;
  ModelReport& report_;
  ObservedPolicy policy_;
  std::vector<std::vector<double>> totals_;                          // per MDP and state
  std::vector<std::unordered_map<std::string, StateIndex>> states_;  // per MDP, once they are asked for
  std::unordered_set<std::string> keys_;
  bool has_probabilities_ = false;
};

}  // namespace

PolicyReading parse_policy(std::string_view text, const std::string& name, const Domain& domain) {
  const detail::ModelText file{name, name, std::string{text}};
  ModelReport report;
  PolicyReader reader{file, domain, report};
  reader.read();
  PolicyReading reading{std::nullopt, report.diagnostics()};
  if (!report.has_errors()) reading.policy = reader.take();
  return reading;
}

}  // namespace kith
