#include "kith/fit/import_logs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "kith/core/text.hpp"
#include "kith/domains/domain_file.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

using Json = nlohmann::json;
using detail::OpenRow;

enum class TrialKind { kDemonstration, kTest, kFeedback, kFinalTest };

struct Trial {
  TrialKind kind = TrialKind::kTest;
  bool correct = false;
  std::string component;
  std::vector<HalfSpace> half_spaces;
  std::vector<HalfSpace> prior;  // what people know beforehand, if the row says so
  std::size_t line = 0;
};

struct Participant {
  std::string condition;
  std::string type;
  std::size_t line = 0;  // of the first row
  std::vector<Trial> trials;
};

const std::map<std::string, TrialKind>& kinds() {
  static const std::map<std::string, TrialKind> kKinds{
      {"demo", TrialKind::kDemonstration},           {"remedial demo", TrialKind::kDemonstration},
      {"diagnostic test", TrialKind::kTest},         {"remedial test", TrialKind::kTest},
      {"diagnostic feedback", TrialKind::kFeedback}, {"remedial feedback", TrialKind::kFeedback},
      {"final test", TrialKind::kFinalTest}};
  return kKinds;
}

const std::set<std::string>& conditions() {
  static const std::set<std::string> kConditions{"open", "pl", "cl", "wt", "wtcl"};
  return kConditions;
}

std::optional<bool> verdict_of(const std::string& text) {
  static const std::set<std::string> kRight{"1", "1.0", "true", "True", "TRUE"};
  static const std::set<std::string> kWrong{"0", "0.0", "false", "False", "FALSE"};
  if (kRight.contains(text)) return true;
  if (kWrong.contains(text)) return false;
  return std::nullopt;
}

// JSON, unless it is none or lists and objects are nested deeper than anybody needs, so that going through it takes
// little of the stack.
std::optional<Json> json_of(const std::string& text) {
  constexpr int kDeepest = 16;
  bool too_deep = false;
  const auto notice = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  auto value = Json::parse(text, notice, false);
  if (too_deep || value.is_discarded()) return std::nullopt;
  return value;
}

// A part of a name whose parts are separated by '/', so that different people have different names.
std::string part_of_name(const std::string& text) {
  std::string part;
  for (const char c : text) {
    if (c == '/') {
      part += "%2F";
    } else if (c == '%') {
      part += "%25";
    } else {
      part += c;
    }
  }
  return part;
}

// Adds the normals in lists that may be nested: [[1, 0, -4]] or [[[1, 0, -4]]]. False if there is anything else.
bool add_normals(const Json& value, std::vector<HalfSpace>& half_spaces) {
  if (!value.is_array()) return false;
  const bool numbers =
      !value.empty() && std::all_of(value.begin(), value.end(), [](const Json& x) { return x.is_number(); });
  if (!numbers) {
    return std::all_of(value.begin(), value.end(), [&](const Json& one) { return add_normals(one, half_spaces); });
  }
  if (value.size() < 2 || value.size() > IntegerVector::kMaxDimension) return false;
  IntegerVector normal(value.size());
  for (std::size_t k = 0; k < value.size(); ++k) {
    const double x = value[k].get<double>();
    if (!(std::abs(x) < 1e9) || std::abs(x - std::round(x)) > 1e-6) return false;
    normal[k] = std::llround(x);
  }
  if (!normal.is_zero()) half_spaces.emplace_back(normal);
  return true;
}

class TrialImport {
 public:
  explicit TrialImport(std::filesystem::path path) : path_{std::move(path)} {}

  ResponseLogs run() {
    read();
    detail::throw_if_errors(logs_.notes);
    for (auto& [domain, knowledge] : domains_) complete(domain, knowledge);
    detail::throw_if_errors(logs_.notes);
    find_usual_finals();
    for (const auto& [key, participant] : participants_) add_person(key, participant);
    return std::move(logs_);
  }

 private:
  // Person and domain.
  using Key = std::pair<std::string, std::string>;

  // What the rows of a domain say about it.
  struct Knowledge {
    std::size_t num_features = 0;                          // 0: unknown
    std::size_t line = 0;                                  // of the first row
    std::vector<HalfSpace> prior;                          // what people know beforehand; empty: no row says
    std::vector<std::pair<std::size_t, HalfSpace>> shown;  // of the robot, by line
    std::size_t model = 0;
  };

  void complain(std::size_t line, const std::string& id, const std::string& message, const std::string& hint = {}) {
    if (logs_.notes.size() < 20) logs_.notes.push_back(detail::fault(id, message, path_, line, hint));
  }
  void remark(std::size_t line, const std::string& id, const std::string& message) {
    logs_.notes.push_back(detail::note(id, message, path_, line));
  }

  void read() {
    const auto needed = [](std::string name) {
      return Column{
          .name = std::move(name), .type = ColumnType::kText, .description = {}, .unit = {}, .required = true};
    };
    const auto optional = [](std::string name) { return Column{.name = std::move(name), .type = ColumnType::kText}; };
    detail::read_open_csv(path_, {needed("user_id"), needed("domain"), needed("interaction_type")},
                          {optional("loop_condition"), optional("is_opt_response"), optional("mdp_parameters"),
                           optional("kc_id"), optional("group"), optional("learner_type")},
                          logs_.notes, [&](const OpenRow& row) { add_row(row); });
  }

  void add_row(const OpenRow& row) {
    const auto type = *row.text("interaction_type");
    const auto kind = kinds().find(type);
    if (kind == kinds().end()) {
      std::vector<std::string> known;
      for (const auto& [name, one] : kinds()) known.push_back(name);
      const auto nearest = nearest_word(type, known);
      complain(row.line(), "E0709", "'" + type + "' is no type of interaction",
               (nearest.empty() ? "known" : "did you mean '" + nearest + "'? Known") + ": " + joined(known));
      return;
    }
    const auto domain = part_of_name(*row.text("domain"));
    auto person = part_of_name(*row.text("user_id"));
    if (const auto group = row.text("group"); group && !group->empty()) person = part_of_name(*group) + "/" + person;
    auto& participant = participants_[{person, domain}];
    if (participant.trials.empty()) participant.line = row.line();
    note_condition(row, participant);
    note_type(row, participant);
    auto trial = trial_of(row, kind->second);
    if (!trial) return;
    note_domain(row, domains_[domain], *trial);
    participant.trials.push_back(*std::move(trial));
  }

  // All constraints of a domain are about the same features, and people know the same beforehand.
  void note_domain(const OpenRow& row, Knowledge& known, const Trial& trial) {
    if (known.line == 0) known.line = row.line();
    for (const auto* half_spaces : {&trial.half_spaces, &trial.prior}) {
      for (const auto& half_space : *half_spaces) {
        if (known.num_features == 0) known.num_features = half_space.dimension();
        if (half_space.dimension() == known.num_features) continue;
        complain(row.line(), "E0707",
                 "a constraint has " + std::to_string(half_space.dimension()) +
                     " numbers, those of this domain before " + std::to_string(known.num_features),
                 "give one number per feature of the domain");
        return;
      }
    }
    if (trial.kind == TrialKind::kDemonstration || trial.kind == TrialKind::kFeedback) {
      for (const auto& half_space : trial.half_spaces) known.shown.emplace_back(row.line(), half_space);
    }
    if (known.prior.empty()) known.prior = trial.prior;
    if (!trial.prior.empty() && trial.prior != known.prior) {
      complain(row.line(), "E0707", "the prior is another one than before",
               "all people of a domain know the same beforehand; give it in one row, or the same in every row");
    }
  }

  // What people of a domain know beforehand: as the rows say, as in the domain of that name, or that actions, taken
  // to be the last feature, cost something.
  void complete(const std::string& name, Knowledge& known) {
    const auto built_in = std::find_if(built_in_domains().begin(), built_in_domains().end(),
                                       [&](const BuiltInDomain& one) { return one.name == name; });
    const std::size_t n = known.num_features == 0 ? 3 : known.num_features;
    if (known.prior.empty() && built_in != built_in_domains().end()) take_from(load_domain(name), n, known);
    if (known.prior.empty()) {
      remark(known.line, "W0708",
             "no row of domain '" + name + "' has a prior: feature " + std::to_string(n) +
                 " of every constraint, the last, is taken for the one that people know to cost something");
      IntegerVector cost(n);
      cost[n - 1] = -1;
      known.prior = {HalfSpace{cost}};
    }
    const auto cone = Cone::intersection(known.prior);
    if (!cone) return complain(known.line, "E0707", "no weights satisfy the prior of domain '" + name + "'");
    const auto same = std::find_if(logs_.models.begin(), logs_.models.end(),
                                   [&](const KnownLearner& model) { return model.prior == *cone; });
    known.model = static_cast<std::size_t>(same - logs_.models.begin());
    if (same != logs_.models.end()) return;
    logs_.models.emplace_back().prior = *cone;
  }

  // The prior of a domain that comes with kith, if what was shown to people holds for its robot.
  void take_from(const Domain& domain, std::size_t num_features, Knowledge& known) {
    if (domain.num_features() != num_features) return;
    for (const auto& [line, half_space] : known.shown) {
      if (half_space.contains(domain.weights().integer)) continue;
      return complain(
          line, "E0707", "people were shown what the robot of '" + domain.id() + "' contradicts",
          "its features are " + joined(domain.feature_names()) + ", in this order; if they are not, give a prior");
    }
    known.prior = domain.prior();
  }

  void note_condition(const OpenRow& row, Participant& participant) {
    const auto condition = row.text("loop_condition").value_or("");
    if (condition.empty()) return;
    if (!conditions().contains(condition)) {
      complain(row.line(), "E0709", "'" + condition + "' is no loop_condition", "known: open, pl, cl, wt, wtcl");
    } else if (participant.condition.empty()) {
      participant.condition = condition;
    } else if (participant.condition != condition) {
      remark(row.line(), "W0701",
             "loop_condition changes from '" + participant.condition + "' to '" + condition +
                 "' within a person; the first one counts");
    }
  }

  void note_type(const OpenRow& row, Participant& participant) {
    const auto type = row.text("learner_type").value_or("");
    if (type.empty()) return;
    if (participant.type.empty()) {
      participant.type = type;
    } else if (participant.type != type) {
      complain(row.line(), "E0709",
               "learner_type changes from '" + participant.type + "' to '" + type + "' within a person",
               "a person is of one type, in every row or in the first");
    }
  }

  std::optional<Trial> trial_of(const OpenRow& row, TrialKind kind) {
    Trial trial{.kind = kind, .correct = false, .component = {}, .half_spaces = {}, .prior = {}, .line = row.line()};
    if (kind == TrialKind::kTest || kind == TrialKind::kFinalTest) {
      const auto text = row.text("is_opt_response").value_or("");
      const auto verdict = verdict_of(text);
      if (!verdict) {
        complain(row.line(), "E0709", "is_opt_response of a test is '" + text + "'", "write 1 or 0, or true or false");
        return std::nullopt;
      }
      trial.correct = *verdict;
    }
    const auto text = row.text("mdp_parameters").value_or("");
    if (!text.empty()) {
      const auto parameters = json_of(text).value_or(Json{});
      if (!parameters.is_object() ||
          (parameters.contains("constraints") && !add_normals(parameters["constraints"], trial.half_spaces))) {
        complain(row.line(), "E0707",
                 "mdp_parameters is no JSON object with a list of normals, 2 to 8 whole numbers each, as "
                 "'constraints'");
        return std::nullopt;
      }
      if (parameters.contains("prior") && !add_normals(parameters["prior"], trial.prior)) {
        complain(row.line(), "E0707", "the prior in mdp_parameters is no list of normals, 2 to 8 whole numbers each");
        return std::nullopt;
      }
      if (parameters.contains("variable_filter")) trial.component = parameters["variable_filter"].dump();
    }
    if (const auto component = row.text("kc_id"); component && !component->empty()) trial.component = *component;
    return trial;
  }

  static std::size_t finals_of(const Participant& participant) {
    return static_cast<std::size_t>(std::count_if(participant.trials.begin(), participant.trials.end(),
                                                  [](const Trial& t) { return t.kind == TrialKind::kFinalTest; }));
  }

  static bool has(const Participant& participant, TrialKind kind) {
    return std::any_of(participant.trials.begin(), participant.trials.end(),
                       [&](const Trial& trial) { return trial.kind == kind; });
  }

  // How many final tests most people have, by domain.
  void find_usual_finals() {
    std::map<std::string, std::map<std::size_t, std::size_t>> counts;
    for (const auto& [key, participant] : participants_) ++counts[key.second][finals_of(participant)];
    for (const auto& [domain, of_number] : counts) {
      usual_finals_[domain] = std::max_element(of_number.begin(), of_number.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                              })->first;
    }
  }

  void add_person(const Key& key, const Participant& participant) {
    const auto name = key.first + "/" + key.second;
    const auto& condition = participant.condition;
    if (condition == "wt" || condition == "wtcl") {
      remark(participant.line, "W0705", "person " + name + " was told the weights and is left out");
      return;
    }
    const bool feedback = has(participant, TrialKind::kFeedback);
    if (condition == "open" && (feedback || has(participant, TrialKind::kTest))) {
      remark(participant.line, "W0701",
             "person " + name + " is labelled 'open' but was tested or corrected while learning; the rows count");
    }
    if (condition == "cl" && !feedback) {
      remark(participant.line, "W0701",
             "person " + name + " is labelled 'cl' but never heard feedback; the rows count");
    }
    const auto finals = finals_of(participant);
    if (finals != usual_finals_[key.second]) {
      remark(participant.line, "W0702",
             "person " + name + " has " + std::to_string(finals) + " final tests, most have " +
                 std::to_string(usual_finals_[key.second]) + "; those that are there count");
    }
    PersonLog log;
    log.id = name;
    log.type = participant.type;
    log.model = domains_.at(key.second).model;
    fill(log, participant, feedback);
    logs_.people.push_back(std::move(log));
  }

  void fill(PersonLog& log, const Participant& participant, bool has_feedback) {
    std::map<std::string, std::size_t> components;
    std::size_t repaired = 0;
    std::vector<HalfSpace> shown;
    const auto& trials = participant.trials;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const auto& trial = trials[i];
      if (trial.kind == TrialKind::kDemonstration || trial.kind == TrialKind::kFeedback) {
        shown.insert(shown.end(), trial.half_spaces.begin(), trial.half_spaces.end());
        continue;
      }
      LoggedPeriod period;
      period.component = components.try_emplace(trial.component, components.size() + 1).first->second;
      // A final examination goes across components; nothing is learned in it.
      if (trial.kind == TrialKind::kFinalTest && !log.periods.empty()) period.component = log.periods.back().component;
      period.conveyed = std::exchange(shown, {});
      if (!trial.half_spaces.empty()) period.answers.push_back({trial.half_spaces, trial.correct});
      period.chance = trial.half_spaces.empty() ? 1.0 : 0.5;
      period.all_correct = trial.correct;
      const bool heard = i + 1 < trials.size() && trials[i + 1].kind == TrialKind::kFeedback;
      const bool missing = trial.kind == TrialKind::kTest && !heard && trial.correct && has_feedback;
      repaired += missing ? 1u : 0u;
      period.feedback = heard || missing;
      if (heard) period.taught = trials[++i].half_spaces;
      if (period.feedback && period.taught.empty()) period.taught = trial.half_spaces;
      ++log.answered;
      log.correct += trial.correct ? 1u : 0u;
      log.periods.push_back(std::move(period));
    }
    if (repaired > 0) {
      remark(participant.line, "W0703",
             "person " + log.id + ": after " + std::to_string(repaired) +
                 " right answers there is no feedback row; they count as heard");
    }
  }

  std::filesystem::path path_;
  std::map<Key, Participant> participants_;
  std::map<std::string, std::size_t> usual_finals_;
  std::map<std::string, Knowledge> domains_;
  ResponseLogs logs_;
};

}  // namespace

ResponseLogs import_trials(const std::filesystem::path& path) { return TrialImport{path}.run(); }

}  // namespace kith
