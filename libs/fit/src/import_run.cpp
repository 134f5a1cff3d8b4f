#include "kith/fit/import_logs.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "kith/bec/atlas.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/published_run.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/read_records.hpp"
#include "kith/study/study.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// Member of a team; 0: everybody in it.
struct Seat {
  std::size_t team = 0;
  std::size_t member = 0;
  friend auto operator<=>(const Seat&, const Seat&) = default;
};

struct Shown {
  std::size_t component = 1;
  std::vector<HalfSpace> half_spaces;
};

struct Answered {
  ResponseRecord response;
  StartIndex start;
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
                                 "give the folder of a run, or a CSV file with one row per trial")}};
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

  template <typename Record, typename OnRecord>
  void read_table(const std::string& table, const std::vector<std::string_view>& wanted, OnRecord on_record) {
    const auto text = run_.read("tables/" + table);
    read_records<Record>({text, (tables_ / table).string(), &*study_.study, addresses_}, wanted, on_record);
  }

  void read_learners() {
    read_table<LearnerRecord>(
        "learners.csv", {columns::kMember, columns::kType, "ability", "confirm_gain", "correct_gain"},
        [&](const RecordRow& row, const LearnerRecord& learner) {
          const auto& types = study_.study->variants[row.address.variant].learner_types;
          const auto type = std::ranges::find(types, learner.type, &LearnerType::letter);
          if (type == types.end())
            row.refuse("E0708", std::string{"there is no learner type '"} + learner.type + "' in inputs/study.toml",
                       "");
          const Seat seat{row.address.team, learner.member};
          types_[seat] = learner.type;
          const auto& traits = learner.traits;  // of the kind 'bayesian'
          if (traits.size() == 3) truths_[seat] = {traits[0], traits[1], traits[2]};
        });
  }

  void read_demonstrations() {
    read_table<DemonstrationRecord>(
        "demonstrations.csv",
        {columns::kPeriod, columns::kComponent, columns::kMdp, columns::kStart, columns::kConstraint, columns::kMember},
        [&](const RecordRow& row, const DemonstrationRecord& record) {
          auto& shown = shown_[{row.address.team, record.member}][record.period];
          shown.component = record.component;
          shown.half_spaces.insert(shown.half_spaces.end(), record.constraints.begin(), record.constraints.end());
          static_cast<void>(start_of(row, record));
        });
  }

  void read_responses() {
    read_table<ResponseRecord>(
        "responses.csv",
        {columns::kPeriod, columns::kComponent, columns::kTest, columns::kMember, columns::kMdp, columns::kStart,
         columns::kCorrect, columns::kCovered, columns::kAnswer},
        [&](const RecordRow& row, const ResponseRecord& record) {
          answers_[{row.address.team, record.member}][record.period].push_back({record, start_of(row, record)});
        });
  }

  // Where a demonstration or a test of a row starts.
  template <typename Record>
  [[nodiscard]] StartIndex start_of(const RecordRow& row, const Record& record) const {
    const auto& domain = atlas_->domain();
    if (record.mdp >= domain.num_mdps() || record.start >= domain.mdp(MdpIndex{record.mdp}).num_states()) {
      row.refuse("E0708",
                 "there is no start " + std::to_string(record.start) + " of world " + std::to_string(record.mdp) +
                     " in inputs/domain.toml",
                 "");
    }
    return atlas_->index({MdpIndex{record.mdp}, StateIndex{record.start}});
  }

  void add_person(const Seat& seat, char type) {
    const auto variant = addresses_[seat.team - 1].variant;
    PersonLog person;
    person.id = std::to_string(seat.team) + "/" + std::to_string(seat.member);
    person.type = type;
    person.model = models_of_[variant].at(type);
    if (const auto truth = truths_.find(seat); truth != truths_.end()) person.truth = truth->second;
    const auto alone = shown_.find(seat);
    const auto together = shown_.find({seat.team, 0});
    const auto& shown = alone != shown_.end()      ? alone->second
                        : together != shown_.end() ? together->second
                                                   : std::map<std::size_t, Shown>{};
    auto& answers = answers_[seat];
    std::set<std::size_t> periods;
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
    period.component = answers.empty() ? shown.component : answers.front().response.component;
    period.conveyed = shown.half_spaces;
    std::ranges::sort(answers, {}, [](const Answered& answered) { return answered.response.test; });
    std::set<HalfSpace> possible;
    for (const auto& [response, start] : answers) {
      if (const auto* tables = atlas_->find_tables()) {
        const auto facets = tables->finite_region(start).facets();
        possible.insert(facets.begin(), facets.end());
      }
      period.all_correct = period.all_correct && response.correct;
      for (const auto& half_space : response.covered) {  // once, however many test sets examined it: as Session does
        const bool is_new = std::find(period.taught.begin(), period.taught.end(), half_space) == period.taught.end();
        if (is_new) period.taught.push_back(half_space);
      }
      person.correct += response.correct ? 1u : 0u;
      ++person.answered;
      add_answer(period, response, start);
    }
    period.possible.assign(possible.begin(), possible.end());
    period.feedback = !answers.empty();
    return period;
  }

  void add_answer(LoggedPeriod& period, const ResponseRecord& answered, StartIndex start) {
    if (!answered.answer) {  // no answer at all: nothing is known of the weight
      ++num_unanswered_;
      return;
    }
    period.given.push_back({start, *answered.answer});
    period.given_right.push_back(answered.correct);
    if (!atlas_->find_tables()) return;  // find_answer_regions() goes on
    const auto coverage = atlas_->tables().coverage_set(start);
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
        {atlas_->constraints().half_spaces(atlas_->tables().robot_cell_facets(start)), answered.correct});
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
  std::map<Seat, char> types_;
  std::map<Seat, TrueParameters> truths_;
  std::map<Seat, std::map<std::size_t, Shown>> shown_;
  std::map<Seat, std::map<std::size_t, std::vector<Answered>>> answers_;
  std::size_t num_unknown_paths_ = 0;
  std::size_t num_unanswered_ = 0;
  ResponseLogs logs_;
};

}  // namespace

ResponseLogs import_run_folder(const fs::path& folder, AnswerDetail detail, const StudyKinds& kinds) {
  return RunImport{folder, detail, kinds}.run();
}

}  // namespace kith
