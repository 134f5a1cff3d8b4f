// kith's own layout of explicit models: states.csv and transitions.csv.
#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/domains/model_formats.hpp"
#include "kith/files/csv_reader.hpp"

namespace kith::detail {
namespace {

constexpr std::array<std::string_view, 6> kStateColumns{"mdp", "state", "name", "terminal", "start", "initial"};

bool contains(const std::vector<Column>& columns, std::string_view name) {
  return std::any_of(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
}

Column column(std::string_view name, ColumnType type, bool required) {
  return {.name = std::string{name}, .type = type, .required = required};
}

class CsvModelReader {
 public:
  CsvModelReader(const ModelText& states, const ModelText& transitions, const std::vector<std::string>& features,
                 RawModel& model, ModelReport& report)
      : states_{states}, transitions_{transitions}, features_{features}, model_{model}, report_{report} {}

  void read() {
    const auto states = header(states_);
    const auto transitions = header(transitions_);
    if (!states || !transitions) return;
    states_by_mdp_ = contains(*states, "mdp");
    // Where the states are those of every MDP, the transitions alone say which MDPs there are.
    transitions_by_mdp_ = states_by_mdp_ || contains(*transitions, "mdp");
    has_probability_ = contains(*transitions, "probability");
    if (!transitions_by_mdp_ || !states_by_mdp_) (void)mdp_number(transitions_by_mdp_ ? kShared : "", {&states_});
    read_states(*states);
    if (!report_.has_errors()) read_transitions();
    if (transitions_by_mdp_ && !states_by_mdp_) model_.mdps.erase(model_.mdps.begin());
  }

 private:
  static constexpr const char* kShared = "\n";  // no name that a file can have by accident: it holds what all share

  std::optional<std::vector<Column>> header(const ModelText& file) {
    try {
      return read_csv_header(file.text, file.shown);
    } catch (const Error& error) {
      report_.take(error.diagnostics());
      return std::nullopt;
    }
  }

  std::optional<std::size_t> mdp_number(const std::string& name, const ModelPlace& place) {
    const auto at = numbers_.find(name);
    if (at != numbers_.end()) return at->second;

    if (model_.mdps.size() > kMaxModelMdps) {
      report_.error("E0257", place, "there are more than " + std::to_string(kMaxModelMdps) + " MDPs",
                    "split the model into several domains");
      return std::nullopt;
    }
    if (!states_by_mdp_ && !model_.mdps.empty() &&
        (model_.mdps.size() + 1) * model_.mdps.front().states.size() > kMaxModelStates) {
      report_.error("E0257", place, "the MDPs have more than " + std::to_string(kMaxModelStates) + " states together",
                    "give each MDP its own states: a column mdp in " + states_.name);
      return std::nullopt;
    }

    numbers_.emplace(name, model_.mdps.size());
    RawMdp mdp;
    mdp.name = name;
    mdp.file = &transitions_;
    mdp.place = place;

    // States without a column mdp are those of every MDP.
    if (transitions_by_mdp_ && !states_by_mdp_ && !model_.mdps.empty()) {
      mdp.states = model_.mdps.front().states;
      mdp.variables = model_.mdps.front().variables;
    }

    model_.mdps.push_back(std::move(mdp));
    keys_.emplace_back();
    return model_.mdps.size() - 1;
  }

  void read_states(const std::vector<Column>& header) {
    std::vector<Column> columns;
    if (states_by_mdp_) columns.push_back(column("mdp", ColumnType::kText, true));
    columns.push_back(column("state", ColumnType::kText, true));
    columns.push_back(column("terminal", ColumnType::kBoolean, true));

    const std::size_t first_optional = columns.size();
    for (const std::string_view name : {"name", "start", "initial"}) {
      if (contains(header, name)) {
        columns.push_back(column(name, name == "name" ? ColumnType::kText : ColumnType::kBoolean, false));
      }
    }

    // All other columns are variables.
    const std::size_t first_variable = columns.size();
    for (const Column& other : header) {
      if (std::find(kStateColumns.begin(), kStateColumns.end(), other.name) != kStateColumns.end()) continue;
      columns.push_back(column(other.name, ColumnType::kInteger, true));
      model_.variables.push_back(other.name);
    }

    if (model_.variables.size() > kMaxVariables) {
      report_.error("E0257", {&states_}, "states have more than " + std::to_string(kMaxVariables) + " variables",
                    "other columns than mdp, state, name, terminal, start and initial are integer variables");
      return;
    }
    const auto on_row = [&](const CsvRow& row) { add_state(row, columns, first_optional, first_variable); };
    report_.take(read_csv(states_.text, states_.shown, columns, on_row));
  }

  void add_state(const CsvRow& row, const std::vector<Column>& columns, std::size_t first_optional,
                 std::size_t first_variable) {
    if (report_.is_full()) return;
    const std::size_t key = states_by_mdp_ ? 1 : 0;
    const ModelPlace place = place_of(states_, row.written(key));
    const auto number = states_by_mdp_ ? mdp_number(std::get<std::string>(row.cells[0]), place) : 0;
    if (!number) return;
    RawMdp& mdp = model_.mdps[*number];
    RawState state;
    state.key = std::get<std::string>(row.cells[key]);
    state.terminal = std::get<bool>(row.cells[key + 1]);
    state.place = place;
    for (std::size_t c = first_optional; c < first_variable; ++c) {
      if (const auto* text = std::get_if<std::string>(&row.cells[c])) state.name = *text;
      const auto* flag = std::get_if<bool>(&row.cells[c]);
      if (flag != nullptr) (columns[c].name == "start" ? state.start : state.initial) = *flag;
    }
    if (!keys_[*number].try_emplace(state.key, static_cast<std::uint32_t>(mdp.states.size())).second) {
      report_.error("E0241", place, "state '" + state.key + "' is given twice",
                    states_by_mdp_ ? "list a state only once per MDP" : "give each state one row");
      return;
    }
    mdp.states.push_back(std::move(state));
    for (std::size_t c = first_variable; c < columns.size(); ++c) {
      const std::int64_t value = std::get<std::int64_t>(row.cells[c]);
      if (value > std::numeric_limits<std::int32_t>::max() || value < std::numeric_limits<std::int32_t>::min()) {
        report_.error("E0249", place_of(states_, row.written(c)), "variable '" + columns[c].name + "' is too large",
                      "variables are integers below 2^31 in size");
      }
      mdp.variables.push_back(static_cast<std::int32_t>(value));
    }
  }

  void read_transitions() {
    std::vector<Column> columns;
    if (transitions_by_mdp_) columns.push_back(column("mdp", ColumnType::kText, true));
    const std::size_t first = columns.size();
    for (const std::string_view name : {"state", "action", "next"}) {
      columns.push_back(column(name, ColumnType::kText, true));
    }
    if (has_probability_) columns.push_back(column("probability", ColumnType::kReal, true));
    const std::size_t first_feature = columns.size();
    for (const std::string& name : features_) {
      if (contains(columns, name)) return;  // a feature cannot be called so; reported with the domain file
      columns.push_back(column(name, ColumnType::kReal, true));
    }
    std::vector<double> features(features_.size());
    const auto on_row = [&](const CsvRow& row) {
      if (!report_.is_full()) add_transition(row, first, first_feature, features);
    };
    report_.take(read_csv(transitions_.text, transitions_.shown, columns, on_row));
  }

  void add_transition(const CsvRow& row, std::size_t first, std::size_t first_feature, std::vector<double>& features) {
    const auto place = [&](std::size_t c) { return place_of(transitions_, row.written(c)); };
    const auto text = [&](std::size_t c) { return std::get<std::string>(row.cells[c]); };
    const auto number = transitions_by_mdp_ ? mdp_of_row(text(0), place(0)) : std::optional<std::size_t>{0};
    if (!number || !has_room(model_, place(first), report_)) return;

    RawTransition transition;
    const auto state = state_number(*number, text(first), place(first));
    const auto action = action_number(model_, text(first + 1), place(first + 1), report_);
    const auto next = state_number(*number, text(first + 2), place(first + 2));
    if (!state || !action || !next) return;
    transition.state = *state;
    transition.action = *action;
    transition.next = *next;
    transition.at = static_cast<std::uint32_t>(place(first).offset);
    transition.probability_at = transition.at;

    if (has_probability_) {
      transition.probability = std::get<double>(row.cells[first + 3]);
      transition.probability_at = static_cast<std::uint32_t>(place(first + 3).offset);
    }

    for (std::size_t k = 0; k < features.size(); ++k) {
      features[k] = std::get<double>(row.cells[first_feature + k]);
      if (!check_finite(features[k], "feature '" + features_[k] + "'", place(first_feature + k), report_)) return;
    }
    transition.features = model_.features.number_of(features);
    model_.add(model_.mdps[*number], transition);
  }

  std::optional<std::size_t> mdp_of_row(const std::string& name, const ModelPlace& place) {
    const auto at = numbers_.find(name);
    if (at != numbers_.end() || !states_by_mdp_) return mdp_number(name, place);
    std::vector<std::string> known;
    for (const RawMdp& mdp : model_.mdps) known.push_back(mdp.name);
    report_.error("E0242", place, "MDP '" + name + "' has no states in " + states_.name, name_hint(name, known));
    return std::nullopt;
  }

  std::optional<std::uint32_t> state_number(std::size_t mdp, const std::string& key, const ModelPlace& place) {
    const auto& keys = keys_[states_by_mdp_ ? mdp : 0];
    const auto at = keys.find(key);
    if (at != keys.end()) return at->second;
    std::vector<std::string> known;
    for (const RawState& state : model_.mdps[mdp].states) known.push_back(state.key);
    report_.error("E0240", place, "there is no state '" + key + "' in " + states_.name, name_hint(key, known));
    return std::nullopt;
  }

  const ModelText& states_;
  const ModelText& transitions_;
  const std::vector<std::string>& features_;
  RawModel& model_;
  ModelReport& report_;
  bool states_by_mdp_ = false;
  bool transitions_by_mdp_ = false;
  bool has_probability_ = false;
  std::unordered_map<std::string, std::size_t> numbers_;              // of MDPs by name
  std::vector<std::unordered_map<std::string, std::uint32_t>> keys_;  // of states, per MDP
};

}  // namespace

void read_csv_model(const ModelText& states, const ModelText& transitions, const std::vector<std::string>& features,
                    RawModel& model, ModelReport& report) {
  CsvModelReader{states, transitions, features, model, report}.read();
}

}  // namespace kith::detail
