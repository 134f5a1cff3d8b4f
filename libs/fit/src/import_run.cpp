#include "kith/fit/import_run.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

#include "kith/bec/atlas.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study.hpp"
#include "kith/table/column_names.hpp"
#include "open_table.hpp"
#include "vectors.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using detail::OpenRow;

Column needed(std::string name, ColumnType type) {
  return {.name = std::move(name), .type = type, .description = {}, .unit = {}, .required = true};
}

// Member of a team; 0: everybody in it.
struct Seat {
  std::int64_t team = 0;
  std::int64_t member = 0;
  friend auto operator<=>(const Seat&, const Seat&) = default;
};

struct Shown {
  std::int64_t component = 1;
  std::vector<HalfSpace> half_spaces;
};

struct Answered {
  std::int64_t test = 0;
  std::int64_t component = 1;
  StartIndex demo;
  bool correct = false;
  std::optional<IntegerVector> answer{};
  std::vector<HalfSpace> covered;
  std::size_t line = 0;
};

class RunImport {
 public:
  RunImport(const fs::path& folder, AnswerDetail detail, const StudyKinds& kinds)
      : tables_{folder / "tables"},
        folder_{folder},
        detail_{detail},
        run_{published(folder)},
        study_{study_of(folder, kinds)},
        atlas_{std::make_shared<const Atlas>(*study_.domain)} {}

  ResponseLogs run() {
    check_study();
    add_models();
    read_learners();
    read_demonstrations();
    read_responses();
    detail::throw_if_errors(logs_.notes);
    if (types_.empty() || answers_.empty()) {
      throw Error{{detail::fault("E0705", "there is not a single answer", tables_ / "responses.csv", 0)}};
    }
    for (const auto& [seat, type] : types_) add_person(seat, type);
    add_notes();
    return std::move(logs_);
  }

 private:
  static PublishedRun published(const fs::path& folder) {
    std::error_code ignored;
    if (!fs::exists(folder / "inputs" / "study.toml", ignored)) {
      throw Error{{detail::fault("E0703", "this folder holds no answers that can be read", folder, 0,
                                 "give the folder of a run, the folder of the Lee et al. (2021) tables, or a "
                                 "CSV file with one row per trial")}};
    }
    if (!fs::exists(folder / "manifest.json", ignored) || !fs::exists(folder / "tables", ignored)) {
      throw Error{{detail::fault("E0704", "this run is not finished: it has no manifest.json or no tables", folder, 0,
                                 "run the study again into the same folder")}};
    }
    return PublishedRun::open(folder);
  }

  static StudyReading study_of(const fs::path& folder, const StudyKinds& kinds) {
    auto reading = read_run_folder(folder, kinds);
    detail::throw_if_errors(reading.diagnostics);
    return reading;
  }

  void check_study() {
    const auto study_file = folder_ / "inputs" / "study.toml";
    for (const auto& variant : study_.study->variants) {
      if (variant.learner_counterfactuals_self) {
        throw Error{{detail::fault("E0706",
                                   "people imagine counterfactuals of their own here, so the tables do not say what a "
                                   "demonstration conveyed to them",
                                   study_file, 0, "set teacher.learner_counterfactuals = \"teacher\"")}};
      }
      if (variant.teaching.release) {
        throw Error{{detail::fault("E0713", "people were released from components, which the method does not describe",
                                   study_file, 0, "fit a run without stop.release")}};
      }
      for (const auto& type : variant.learner_types) {
        if (type.model->kind == bayesian_model().kind) continue;
        throw Error{{detail::fault("E0712",
                                   "learners of type '" + std::string{type.letter} + "' are of the kind '" +
                                       std::string{type.model->kind} +
                                       "'; the parameters of populations are fitted for the kind 'bayesian' only",
                                   study_file, 0)}};
      }
      if (variant.record == RecordLevel::kTeam) {
        throw Error{{detail::fault("E0705", "only teams were recorded, so there are no answers to fit to", study_file,
                                   0, "run the study with record.level = \"period\"")}};
      }
    }
    addresses_ = team_addresses(*study_.study);
  }

  // The parameters that all kinds have.
  [[nodiscard]] static ParameterValues as_bayesian(const ParameterValues& parameters) {
    ParameterValues values{bayesian_model().parameters};
    for (const auto& parameter : values.declared()) {
      for (std::size_t i = 0; i < parameters.declared().size(); ++i) {
        if (parameters.declared()[i].name == parameter.name) values.set(parameter.name, parameters.values()[i]);
      }
    }
    return values;
  }

  void add_models() {
    for (const auto& variant : study_.study->variants) {
      auto& of_type = models_of_.emplace_back();
      for (const auto& type : variant.learner_types) {
        of_type[type.letter] = logs_.models.size();
        auto prior = type.prior ? Cone{atlas_->domain().num_features()} : atlas_->prior_cone();
        const bool has_room = !type.prior || prior.clip(*type.prior);
        KITH_ASSERT(has_room);  // else the study could not be read
        logs_.models.push_back({.parameters = as_bayesian(type.parameters),
                                .prior = std::move(prior),
                                .form = variant.teaching.likelihood,
                                .atlas = atlas_});
      }
    }
  }

  void read_table(const std::string& file, std::vector<Column> required, std::vector<Column> optional,
                  std::vector<Diagnostic>& diagnostics, const std::function<void(const OpenRow&)>& on_row) {
    detail::read_open_csv(run_.read("tables/" + file), (tables_ / file).string(), std::move(required),
                          std::move(optional), diagnostics, on_row);
  }

  void complain(const std::string& file, std::size_t line, const std::string& id, const std::string& message) {
    if (logs_.notes.size() < 20) logs_.notes.push_back(detail::fault(id, message, tables_ / file, line));
  }

  [[nodiscard]] bool check_team(const std::string& file, const OpenRow& row) {
    const auto team = row.integer(columns::kTeam).value_or(0);
    if (team >= 1 && static_cast<std::size_t>(team) <= addresses_.size()) return true;
    complain(file, row.line(), "E0708", "there is no team " + std::to_string(team) + " in inputs/study.toml");
    return false;
  }

  void read_learners() {
    const std::string file = "learners.csv";
    read_table(file,
               {needed(columns::kTeam, ColumnType::kInteger), needed(columns::kMember, ColumnType::kInteger),
                needed(columns::kType, ColumnType::kText)},
               {{.name = "ability", .type = ColumnType::kReal},
                {.name = "confirm_gain", .type = ColumnType::kReal},
                {.name = "correct_gain", .type = ColumnType::kReal}},
               logs_.notes, [&](const OpenRow& row) {
                 if (!check_team(file, row)) return;
                 const auto type = *row.text(columns::kType);
                 const auto variant = addresses_[static_cast<std::size_t>(*row.integer(columns::kTeam)) - 1].variant;
                 if (type.size() != 1 || !models_of_[variant].contains(type[0])) {
                   complain(file, row.line(), "E0708", "there is no learner type '" + type + "' in inputs/study.toml");
                   return;
                 }
                 const Seat seat{*row.integer(columns::kTeam), *row.integer(columns::kMember)};
                 types_[seat] = type;
                 const auto ability = row.real("ability"), confirm = row.real("confirm_gain"),
                            correct = row.real("correct_gain");
                 if (ability && confirm && correct) truths_[seat] = {*ability, *confirm, *correct};
               });
  }

  [[nodiscard]] std::size_t num_features() const { return atlas_->domain().num_features(); }

  // The half-spaces of a cell, or nothing after complaining.
  std::vector<HalfSpace> half_spaces(const std::string& file, const OpenRow& row, const std::string& column) {
    const auto parsed = detail::parse_half_spaces(row.text(column).value_or(""), num_features());
    if (!parsed)
      complain(file, row.line(), "E0707",
               "'" + column + "' does not hold half-spaces, normals of " + std::to_string(num_features()) +
                   " whole numbers each, such as 1 0 -4;0 -1 2");
    return parsed.value_or(std::vector<HalfSpace>{});
  }

  void read_demonstrations() {
    const std::string file = "demonstrations.csv";
    read_table(file,
               {needed(columns::kTeam, ColumnType::kInteger), needed(columns::kPeriod, ColumnType::kInteger),
                needed(columns::kComponent, ColumnType::kInteger), needed(columns::kMdp, ColumnType::kInteger),
                needed(columns::kStart, ColumnType::kInteger), needed(columns::kConstraint, ColumnType::kText)},
               {{.name = columns::kMember, .type = ColumnType::kInteger}}, logs_.notes, [&](const OpenRow& row) {
                 if (!check_team(file, row)) return;
                 auto& shown = shown_[{*row.integer(columns::kTeam), row.integer(columns::kMember).value_or(0)}]
                                     [*row.integer(columns::kPeriod)];
                 shown.component = *row.integer(columns::kComponent);
                 const auto conveyed = half_spaces(file, row, columns::kConstraint);
                 shown.half_spaces.insert(shown.half_spaces.end(), conveyed.begin(), conveyed.end());
                 static_cast<void>(start_of(file, row));
               });
  }

  void read_responses() {
    const std::string file = "responses.csv";
    read_table(
        file,
        {needed(columns::kTeam, ColumnType::kInteger), needed(columns::kPeriod, ColumnType::kInteger),
         needed(columns::kComponent, ColumnType::kInteger), needed(columns::kTest, ColumnType::kInteger),
         needed(columns::kMember, ColumnType::kInteger), needed(columns::kMdp, ColumnType::kInteger),
         needed(columns::kStart, ColumnType::kInteger), needed(columns::kCorrect, ColumnType::kBoolean),
         needed(columns::kCovered, ColumnType::kText)},
        {{.name = columns::kAnswer, .type = ColumnType::kText}}, logs_.notes, [&](const OpenRow& row) {
          if (!check_team(file, row)) return;
          if (const auto answered = response_of(file, row)) {
            answers_[{*row.integer(columns::kTeam), *row.integer(columns::kMember)}][*row.integer(columns::kPeriod)]
                .push_back(*answered);
          }
        });
  }

  // Where a demonstration or a test of a row starts, or nothing after complaining.
  std::optional<StartIndex> start_of(const std::string& file, const OpenRow& row) {
    const auto& domain = atlas_->domain();
    const auto mdp = *row.integer(columns::kMdp);
    const auto start = *row.integer(columns::kStart);
    if (mdp < 0 || static_cast<std::size_t>(mdp) >= domain.num_mdps() || start < 0 ||
        static_cast<std::size_t>(start) >= domain.mdp(MdpIndex{static_cast<std::size_t>(mdp)}).num_states()) {
      complain(
          file, row.line(), "E0708",
          "there is no start " + std::to_string(start) + " of world " + std::to_string(mdp) + " in inputs/domain.toml");
      return std::nullopt;
    }
    return atlas_->index({MdpIndex{static_cast<std::size_t>(mdp)}, StateIndex{static_cast<std::size_t>(start)}});
  }

  std::optional<Answered> response_of(const std::string& file, const OpenRow& row) {
    const auto demo = start_of(file, row);
    if (!demo) return std::nullopt;
    Answered answered{.test = *row.integer(columns::kTest),
                      .component = *row.integer(columns::kComponent),
                      .demo = *demo,
                      .correct = *row.boolean(columns::kCorrect),
                      .covered = half_spaces(file, row, columns::kCovered),
                      .line = row.line()};
    if (const auto text = row.text(columns::kAnswer); text && !text->empty()) {
      answered.answer = detail::parse_counts(*text, num_features(), atlas_->domain().count_scale());
      if (!answered.answer) {
        complain(file, row.line(), "E0707",
                 "'answer' does not hold " + std::to_string(num_features()) + " feature counts such as 0 1 5");
        return std::nullopt;
      }
    }
    return answered;
  }

  void add_person(const Seat& seat, const std::string& type) {
    const auto variant = addresses_[static_cast<std::size_t>(seat.team) - 1].variant;
    PersonLog person;
    person.id = std::to_string(seat.team) + "/" + std::to_string(seat.member);
    person.type = type;
    person.model = models_of_[variant].at(type[0]);
    if (const auto truth = truths_.find(seat); truth != truths_.end()) person.truth = truth->second;
    const auto alone = shown_.find(seat);
    const auto together = shown_.find({seat.team, 0});
    const auto& shown = alone != shown_.end()      ? alone->second
                        : together != shown_.end() ? together->second
                                                   : std::map<std::int64_t, Shown>{};
    auto& answers = answers_[seat];
    std::set<std::int64_t> periods;
    for (const auto& [period, one] : shown) periods.insert(period);
    for (const auto& [period, list] : answers) periods.insert(period);
    for (const auto period : periods) {
      const auto it = shown.find(period);
      person.periods.push_back(period_of(it == shown.end() ? Shown{} : it->second, answers[period], person));
    }
    logs_.people.push_back(std::move(person));
  }

  LoggedPeriod period_of(const Shown& shown, std::vector<Answered>& answers, PersonLog& person) {
    LoggedPeriod period;
    period.component = static_cast<std::size_t>(answers.empty() ? shown.component : answers.front().component);
    period.conveyed = shown.half_spaces;
    std::sort(answers.begin(), answers.end(), [](const Answered& a, const Answered& b) { return a.test < b.test; });
    std::set<HalfSpace> possible;
    for (const auto& answered : answers) {
      const auto demo = answered.demo;
      if (const auto* tables = atlas_->find_tables()) {
        const auto facets = tables->finite_region(demo).facets();
        possible.insert(facets.begin(), facets.end());
      }
      period.all_correct = period.all_correct && answered.correct;
      for (const auto& half_space : answered.covered) {  // once, however many test sets examined it: as Session does
        const bool is_new = std::find(period.taught.begin(), period.taught.end(), half_space) == period.taught.end();
        if (is_new) period.taught.push_back(half_space);
      }
      person.correct += answered.correct ? 1u : 0u;
      ++person.answered;
      add_answer(period, answered, demo);
    }
    period.possible.assign(possible.begin(), possible.end());
    period.feedback = !answers.empty();
    return period;
  }

  void add_answer(LoggedPeriod& period, const Answered& answered, StartIndex demo) {
    if (!answered.answer) {  // no answer at all: nothing is known of the weight
      ++num_unanswered_;
      return;
    }
    period.given.push_back({demo, *answered.answer});
    period.given_right.push_back(answered.correct);
    if (!atlas_->find_tables()) return;  // find_answer_regions() goes on
    const auto coverage = atlas_->tables().coverage_set(demo);
    const bool known = std::find(coverage.begin(), coverage.end(), *answered.answer) != coverage.end();
    if (detail_ == AnswerDetail::kPath && known) {
      AnswerRegion region;
      for (const auto& other : coverage) {
        if (other != *answered.answer) region.cone.emplace_back(*answered.answer - other);
      }
      period.answers.push_back(std::move(region));
      period.chance /= static_cast<double>(std::max<std::size_t>(coverage.size(), 1));
      return;
    }
    if (detail_ == AnswerDetail::kPath) ++num_unknown_paths_;
    period.answers.push_back(
        {atlas_->constraints().half_spaces(atlas_->tables().robot_cell_facets(demo)), answered.correct});
    period.chance /= 2.0;
  }

  void add_notes() {
    const auto responses = tables_ / "responses.csv";
    if (num_unknown_paths_ > 0) {
      logs_.notes.push_back(detail::note("W0706",
                                         std::to_string(num_unknown_paths_) +
                                             " answers are paths that are best for nobody; they count by their verdict",
                                         responses, 0));
    }
    if (num_unanswered_ > 0) {
      logs_.notes.push_back(detail::note(
          "W0707", std::to_string(num_unanswered_) + " tests were not answered; they say nothing of what people know",
          responses, 0));
    }
    const auto& spec = study_.study->variants.front();
    if (spec.pairing == Pairing::kReplicate && study_.study->variants.size() * spec.strategies.size() > 1) {
      logs_.notes.push_back(
          detail::note("W0704",
                       "the same simulated people are in the teams of every strategy; they count as different ones "
                       "here, so intervals of populations are too narrow",
                       folder_ / "inputs" / "study.toml", 0, "set design.pairing = \"none\""));
    }
  }

  fs::path tables_;
  fs::path folder_;
  AnswerDetail detail_;
  PublishedRun run_;
  StudyReading study_;
  std::shared_ptr<const Atlas> atlas_;
  std::vector<TeamAddress> addresses_;
  std::vector<std::map<char, std::size_t>> models_of_;  // per variant
  std::map<Seat, std::string> types_;
  std::map<Seat, TrueParameters> truths_;
  std::map<Seat, std::map<std::int64_t, Shown>> shown_;
  std::map<Seat, std::map<std::int64_t, std::vector<Answered>>> answers_;
  std::size_t num_unknown_paths_ = 0;
  std::size_t num_unanswered_ = 0;
  ResponseLogs logs_;
};

}  // namespace

ResponseLogs import_run_folder(const fs::path& folder, AnswerDetail detail, const StudyKinds& kinds) {
  return RunImport{folder, detail, kinds}.run();
}

}  // namespace kith
