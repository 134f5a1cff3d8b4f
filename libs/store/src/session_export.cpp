#include "kith/store/session_export.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "export_tables.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/live/screening.hpp"
#include "kith/present/json.hpp"
#include "kith/store/session_review.hpp"
#include "kith/table/csv_writer.hpp"
#include "room_history.hpp"

namespace kith {
namespace {

std::int64_t ms_of(std::int64_t us) { return us / 1000; }
std::optional<std::int64_t> ms_if_any(std::int64_t us) {
  return us == 0 ? std::nullopt : std::optional<std::int64_t>{us / 1000};
}
std::optional<std::string> if_any(const std::string& text) { return text.empty() ? std::nullopt : std::optional{text}; }
std::optional<double> share(std::size_t part, std::size_t all) {
  return all == 0 ? std::nullopt : std::optional{static_cast<double>(part) / static_cast<double>(all)};
}
// CSV cells hold no zero bytes.
std::string printable(std::string text) {
  std::erase(text, '\0');
  return text;
}

// What a row of tests.csv is about.
struct GivenAnswer {
  std::size_t period = 0;
  std::size_t test = 0;  // from 0
  std::size_t seat = 0;
  std::size_t member = 0;
  const AnswerRow* answer = nullptr;
  [[nodiscard]] auto key() const { return std::tuple{period, test, member, seat}; }
};

// The writers of all tables; hashes what they write.
class Writers {
 public:
  Writers(const SessionExportOptions& options, const ExportSink& sink) : sink_{sink} {
    for (auto& table : export_tables(options)) {
      const auto file = table.file;
      hashes_.try_emplace(file);
      writers_.try_emplace(file, std::move(table.columns), [this, file](std::string_view piece) { put(file, piece); });
    }
  }
  template <typename Row>
  void add(const TableOf<Row>& table, const Row& row) {
    table.write(writers_.at(table.description().file), row);
  }

  void put(const std::string& file, std::string_view piece) {
    hashes_[file].update(piece);
    sink_(file, piece);
  }

  ExportReport finish(const std::vector<TableDescription>& tables, const std::string& run, const Json& about) {
    ExportReport report;
    for (auto& [file, writer] : writers_) {
      writer.flush();
      report.rows[file] = writer.num_rows();
    }
    put("codebook.json", codebook(tables, run));
    put(kAboutFile, about.dump(2) + "\n");
    std::string sums;
    for (auto& [file, hash] : hashes_) {
      report.hashes[file] = std::move(hash).hex();
      sums += report.hashes[file] + "  " + file + "\n";
    }
    sink_("SHA256SUMS", sums);
    return report;
  }

 private:
  const ExportSink& sink_;
  std::map<std::string, Sha256> hashes_;
  std::map<std::string, CsvWriter> writers_;
};

class Exporter {
 public:
  Exporter(const std::shared_ptr<const LiveStudy>& study, const SessionExportOptions& options, const ExportSink& sink)
      : study_{study}, atlas_{*study->atlas}, options_{options}, tables_{options}, write_{options, sink} {}

  void add(const RoomHistory& history) {
    history_ = &history;
    const bool is_waiting_list = setup().is_waiting_list;
    if (!is_waiting_list) write_session();
    for (const auto& [seat, row] : history.seats) {
      if (!is_waiting_list || stage_of(seat) != "moved") write_participant(seat, row);
    }
    for (const auto& lesson : history.lessons) {
      if (!lesson.is_replaced) write_period(lesson);
    }
    write_tests();
    if (options_.with_discussions) write_discussions();
    write_questions();
    write_trials();
    write_beliefs();
    for (const auto& event : history.events) write_event(event);
  }

  ExportReport finish(const EventFile& file) {
    return write_.finish(export_tables(options_), file.identity().study, about(file));
  }

 private:
  [[nodiscard]] const std::string& id() const { return history_->replayed.id; }
  [[nodiscard]] const RoomSetup& setup() const { return history_->room->setup(); }
  [[nodiscard]] const Session& session() const { return history_->room->session(); }

  [[nodiscard]] std::string stage_of(std::size_t seat) const {
    return seat <= history_->room->num_seats() ? history_->room->stage_of(seat) : std::string{};
  }

  // Whether another lesson was taught in place of the one that the answer belongs to.
  [[nodiscard]] bool is_void(const AnswerRow& answer) const { return history_->lessons[answer.lesson].is_replaced; }

  // The verdict on an answer, if the period was finished and the member took part.
  [[nodiscard]] const Verdict* verdict(std::size_t period, std::size_t member, std::size_t test) const {
    const auto& past = session().history();
    if (period == 0 || period > past.size() || member == 0) return nullptr;
    const auto& verdicts = past[period - 1].feedback.verdicts;
    if (member > verdicts.size() || test >= verdicts[member - 1].size()) return nullptr;
    return &verdicts[member - 1][test];
  }

  [[nodiscard]] std::optional<std::string> type_of(std::optional<std::size_t> member) const {
    const auto& letters = setup().composition;
    if (!member || *member == 0 || *member > letters.size()) return std::nullopt;
    return std::string{letters[*member - 1]};
  }

  [[nodiscard]] std::optional<double> belief_in(std::size_t member) const {
    const bool is_kept = session().belief().options().members || session().num_members() == 1;
    if (!is_kept || member == 0 || member > session().num_members()) return std::nullopt;
    return session().belief().member(member - 1).mass_in(atlas_.policy_bec_half_spaces());
  }

  void write_session() {
    const auto& past = session().history();
    std::size_t demonstrations = 0, tests = 0, answered = 0, right = 0;
    for (const auto& period : past) {
      demonstrations += period.lesson.demonstrations.size();
      tests += period.lesson.tests.size();
      for (const auto& verdicts : period.feedback.verdicts) {
        for (const auto& verdict : verdicts) {
          ++answered;
          right += verdict.correct ? 1u : 0u;
        }
      }
    }
    std::size_t learned = 0;
    for (const auto status : session().components()) learned += status == ComponentStatus::kLearned ? 1u : 0u;
    double knowledge = 0.0;
    bool is_known = true;
    for (std::size_t member = 1; member <= session().num_members(); ++member) {
      const auto mass = belief_in(member);
      is_known = is_known && mass;
      knowledge += mass.value_or(0.0) / static_cast<double>(session().num_members());
    }
    const auto simulated = std::count(setup().simulated.begin(), setup().simulated.end(), true);
    constexpr const char* kStages[] = {"lobby", "running", "questions", "ended"};
    const auto& events = history_->events;
    const auto size = setup().composition.size();
    write_.add(tables_.sessions, {.session = id(),
                                  .strategy = setup().strategy,
                                  .composition = setup().composition,
                                  .replicate = setup().replicate,
                                  .size = size,
                                  .people = size - static_cast<std::size_t>(simulated),
                                  .created_ms = ms_of(history_->stored.created_us),
                                  .started_ms = ms_if_any(history_->started_us),
                                  .last_ms = ms_if_any(events.empty() ? 0 : events.back().at_us),
                                  .stage = kStages[static_cast<std::size_t>(history_->room->stage())],
                                  .ended = if_any(history_->ended),
                                  .completed = session().status() == SessionStatus::kComplete,
                                  .periods = past.size(),
                                  .demonstrations = demonstrations,
                                  .tests = tests,
                                  .share_right = share(right, answered),
                                  .components_learned = learned,
                                  .knowledge = is_known ? std::optional{knowledge} : std::nullopt,
                                  .digest = history_->replayed.digest});
  }

  void write_participant(std::size_t seat, const SeatRow& person) {
    std::size_t tests = 0, right = 0;
    for (const auto& answer : history_->answers) {
      const bool is_own = answer.seat == seat && !is_void(answer);
      const auto* judged = is_own ? verdict(answer.period, answer.member, answer.test) : nullptr;
      if (judged == nullptr) continue;
      ++tests;
      right += judged->correct ? 1u : 0u;
    }
    const auto group = setup().is_waiting_list ? RoomSetup{} : setup();
    const auto stage = stage_of(seat);
    const bool is_last = person.member && history_->seat_of(*person.member) == seat;
    const auto& screened = person.screened;
    const auto passed = static_cast<std::size_t>(std::count(screened.begin(), screened.end(), true));
    const bool is_screened = !screened.empty() && screened.size() == study_->screening.size();
    ParticipantRow row{.session = id(),
                       .seat = seat,
                       .member = person.member,
                       .type = type_of(person.member),
                       .strategy = if_any(group.strategy),
                       .composition = if_any(group.composition),
                       .simulated = person.simulated,
                       .joined_ms = ms_if_any(person.joined_us),
                       .consent = if_any(person.consent),
                       .stage = if_any(stage),
                       .times_away = person.times_away,
                       .seconds_away = static_cast<double>(person.away_us) / 1e6,
                       .tests = tests,
                       .right = right,
                       .share_right = share(right, tests),
                       .p_bec = is_last ? belief_in(*person.member) : std::nullopt,
                       .name = if_any(printable(person.name))};
    if (is_screened) row.estimate = screening_estimate(passed, screened.size());
    if (!person.query.empty()) row.query = printable(person.query.dump());
    const bool has_code = stage == "debrief" || stage == "ended" || stage == "replaced";
    if (has_code && options_.with_names) row.code = completion_code(*study_, setup().salt, setup().id, seat);
    write_.add(tables_.participants, row);
  }

  void write_period(const LessonRow& lesson_row) {
    const auto& lesson = lesson_row.lesson;
    const auto& past = session().history();
    const auto& source = lesson.source;
    PeriodRow row{.session = id(),
                  .period = lesson.period,
                  .component = lesson.component + 1,
                  .source = source.is_member() ? "member " + std::to_string(source.member + 1) : source.rule,
                  .chosen_ms = ms_of(lesson_row.chosen_us),
                  .demonstrations = lesson.demonstrations.size(),
                  .tests = lesson.tests.size(),
                  .gain = lesson.gain,
                  .area_sr = lesson.area_sr,
                  .digest = lesson_row.digest};
    const bool is_finished = lesson.period <= past.size();
    if (is_finished) {
      const auto& feedback = past[lesson.period - 1].feedback;
      row.n_active = 0;
      row.all_right = true;
      for (std::size_t i = 0; i < feedback.verdicts.size(); ++i) {
        if (feedback.verdicts[i].empty()) continue;
        ++*row.n_active;
        row.all_right = *row.all_right && feedback.all_correct[i];
      }
    }
    write_.add(tables_.periods, row);
  }

  [[nodiscard]] std::vector<GivenAnswer> given_answers() const {
    std::vector<GivenAnswer> rows;
    for (const auto& answer : history_->answers) {
      rows.push_back({.period = answer.period,
                      .test = answer.test,
                      .seat = answer.seat,
                      .member = answer.member,
                      .answer = &answer});
    }
    for (const auto& [seat, person] : history_->seats) {
      if (!person.simulated || !person.member) continue;
      for (std::size_t period = 1; period <= session().history().size(); ++period) {
        const auto& verdicts = session().history()[period - 1].feedback.verdicts[*person.member - 1];
        const auto* lesson = history_->lesson_of(period);
        const bool was_there = lesson != nullptr && person.joined_us <= lesson->chosen_us;
        if (!was_there || seat_in(period, *person.member) != 0) continue;
        for (std::size_t test = 0; test < verdicts.size(); ++test)
          rows.push_back({.period = period, .test = test, .seat = seat, .member = *person.member, .answer = nullptr});
      }
    }
    std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.key() < b.key(); });
    return rows;
  }

  void write_tests() {
    for (const auto& test : given_answers()) {
      const auto* answer = test.answer;
      const auto* lesson_row =
          answer != nullptr ? &history_->lessons[answer->lesson] : history_->lesson_of(test.period);
      if (lesson_row == nullptr || test.test >= lesson_row->lesson.tests.size()) continue;
      const auto& lesson = lesson_row->lesson;
      const auto place = atlas_.id(lesson.tests[test.test].demo);
      const auto* judged = lesson_row->is_replaced ? nullptr : verdict(test.period, test.member, test.test);
      TestRow row{.session = id(),
                  .period = test.period,
                  .component = lesson.component + 1,
                  .test = test.test + 1,
                  .seat = test.seat,
                  .member = test.member,
                  .type = type_of(test.member).value_or(""),
                  .strategy = setup().strategy,
                  .mdp = place.mdp.value(),
                  .mdp_name = if_any(atlas_.domain().world_name(place.mdp)),
                  .start = place.start.value(),
                  .actions = 0,
                  .at_ms = ms_of(answer != nullptr ? answer->at_us : lesson_row->chosen_us)};
      if (answer != nullptr) {
        row.path = path_of(*answer);
        row.actions = answer->actions.size();
        if (answer->ms) row.rt = static_cast<double>(*answer->ms) / 1000.0;
      }
      if (judged != nullptr) {
        row.correct = judged->correct;
        if (judged->answered) row.regret = judged->regret;
      }
      write_.add(tables_.tests, row);
      if (answer != nullptr) write_keys(*answer);
    }
  }

  [[nodiscard]] std::string name_of_action(std::size_t action) const {
    const auto& names = atlas_.domain().action_names();
    return action < names.size() ? names[action] : std::to_string(action);
  }

  [[nodiscard]] std::string path_of(const AnswerRow& answer) const {
    std::string path;
    for (const auto action : answer.actions) path += (path.empty() ? "" : " ") + name_of_action(action);
    return path + (answer.for_ever ? " ..." : "");
  }

  void write_keys(const AnswerRow& answer) {
    if (!answer.keys.is_array()) return;
    std::size_t number = 0;
    for (const auto& key : answer.keys) {
      ++number;
      if (!key.is_array() || key.size() != 2 || !key[1].is_number_integer()) continue;
      std::string action = "?";
      if (key[0].is_number_unsigned()) action = name_of_action(key[0].get<std::size_t>());
      if (key[0].is_string()) action = printable(key[0].get<std::string>());
      write_.add(tables_.keys, {.session = id(),
                                .period = answer.period,
                                .test = answer.test + 1,
                                .seat = answer.seat,
                                .key = number,
                                .action = action,
                                .ms = key[1].get<std::int64_t>()});
    }
  }

  void write_questions() {
    for (const auto& [seat, person] : history_->seats) {
      for (const auto& question : study_->group().questions) {
        const auto answer = person.answers.find(question.id);
        if (answer == person.answers.end() || answer->is_null()) continue;
        const bool is_hidden = question.kind == GroupQuestion::Kind::kText && !options_.with_text;
        QuestionRow row{
            .session = id(), .seat = seat, .question = question.id, .kind = std::string{name_of(question.kind)}};
        if (!is_hidden) row.value = printable(answer->is_string() ? answer->get<std::string>() : answer->dump());
        write_.add(tables_.questions, row);
      }
    }
  }

  // What each person saw, answered and heard, as `kith fit` reads it. Stand-ins are left out.
  void write_trials() {
    for (const auto& period : session().history()) {
      for (std::size_t member = 1; member <= period.feedback.verdicts.size(); ++member) {
        const auto& verdicts = period.feedback.verdicts[member - 1];
        const auto seat = seat_in(period.lesson.period, member);
        if (verdicts.empty() || seat == 0) continue;
        const auto& lesson = period.lesson;
        for (const auto& shown : lesson.demonstrations)
          write_trial(seat, lesson, "demo", std::nullopt, shown.half_spaces);
        for (std::size_t i = 0; i < verdicts.size(); ++i) {
          write_trial(seat, lesson, "diagnostic test", verdicts[i].correct, lesson.tests[i].covered);
          write_trial(seat, lesson, "diagnostic feedback", std::nullopt, lesson.tests[i].covered);
        }
      }
    }
  }

  void write_discussions() {
    for (const auto& past : session().history()) {
      const auto& feedback = past.feedback;
      for (std::size_t m = 0; m < past.revised.size(); ++m) {
        const auto seat = seat_in(past.lesson.period, m + 1);
        for (std::size_t t = 0; t < feedback.verdicts[m].size(); ++t) {
          const bool changed = !past.revised[m].empty() && past.revised[m][t] != past.answers[m][t];
          write_.add(tables_.discussions, {.session = id(),
                                           .period = past.lesson.period,
                                           .component = past.lesson.component + 1,
                                           .test = t + 1,
                                           .seat = seat == 0 ? std::nullopt : std::optional{seat},
                                           .member = m + 1,
                                           .correct = feedback.verdicts[m][t].correct,
                                           .revised_correct = feedback.final_verdicts(m)[t].correct,
                                           .changed = changed});
        }
      }
    }
  }

  // The person who answered for a member in a period; 0: nobody, or a stand-in.
  [[nodiscard]] std::size_t seat_in(std::size_t period, std::size_t member) const {
    for (const auto& answer : history_->answers) {
      if (answer.period == period && answer.member == member && !is_void(answer)) return answer.seat;
    }
    return 0;
  }

  void write_trial(std::size_t seat, const Lesson& lesson, const char* type, std::optional<bool> correct,
                   const std::vector<HalfSpace>& constraints) {
    TrialRow row{.user_id = std::to_string(seat),
                 .group = id(),
                 .domain = atlas_.domain().id(),
                 .kc_id = std::to_string(lesson.component + 1),
                 .interaction_type = type,
                 .mdp_parameters = Json{{"constraints", to_json(constraints, study_->spec.num_features)}}.dump()};
    if (correct) row.is_opt_response = *correct ? "1" : "0";
    write_.add(tables_.trials, row);
  }

  void write_beliefs() {
    const auto detail = history_->room->view({.role = Viewer::Role::kObserver, .seat = 0}, 0)["room"];
    for (const auto& point : detail["curves"]) {
      for (const auto& [name, mass] : point["p_bec"].items()) {
        constexpr std::string_view kMember{"member "};
        BeliefRow row{
            .session = id(), .period = point["period"].get<std::size_t>(), .belief = name, .p_bec = mass.get<double>()};
        if (name.compare(0, kMember.size(), kMember) == 0) row.member = std::stoul(name.substr(kMember.size()));
        write_.add(tables_.beliefs, row);
      }
    }
  }

  // What was taught, and to whom.
  [[nodiscard]] Json about(const EventFile& file) const {
    const auto facts = live_study_json(*study_);
    Json strategies = Json::array();
    for (const auto& strategy : facts["strategies"]) strategies.push_back(strategy["name"]);
    return {{"schema", "kith.session-tables/1"},
            {"session", file.id()},
            {"study", study_->spec.id},
            {"title", study_->spec.title},
            {"domain", facts["domain"]},
            {"program", file.identity().program},
            {"created_ms", ms_of(file.created_us())},
            {"strategies", strategies},
            {"compositions", facts["compositions"]},
            {"types", facts["types"]},
            {"inputs", file.identity().inputs}};
  }

  void write_event(const StoredEvent& event) {
    auto body = body_of(event);
    if (!options_.with_names && body.is_object()) {
      const auto* kind = room_event_kind(event.type);
      for (const auto& member : kind == nullptr ? std::array<PersonalMember, 2>{} : kind->personal) {
        const bool is_words =
            member.what == PersonalMember::What::kWords || member.what == PersonalMember::What::kAnswers;
        if (!is_words) body.erase(std::string{member.name});
      }
    }
    if (!options_.with_text && body.is_object()) {
      for (const auto* name : {"text", "reason"}) {
        if (event.type != happening::Ended::kKind.word) body.erase(name);
      }
      if (event.type == happening::QuestionsAnswered::kKind.word && body.contains("answers")) {
        for (const auto& question : study_->group().questions) {
          if (question.kind == GroupQuestion::Kind::kText) body["answers"].erase(question.id);
        }
      }
    }
    write_.add(tables_.events, {.session = id(),
                                .seq = event.seq,
                                .at_us = event.at_us,
                                .actor = event.actor,
                                .type = event.type,
                                .body = printable(body.dump())});
  }

  const std::shared_ptr<const LiveStudy>& study_;
  const Atlas& atlas_;
  const SessionExportOptions& options_;
  ExportTables tables_;
  Writers write_;
  const RoomHistory* history_ = nullptr;
};

// Compares the numbers of rows with those of the store. @throws kith::Error
void reconcile(const std::filesystem::path& path, const char* file, std::size_t rows, std::size_t stored) {
  if (rows == stored) return;
  refuse_run(ErrorKind::kIo, "E1615", path,
             std::string{"the export is incomplete: "} + file + " has " + std::to_string(rows) + " rows, the session " +
                 std::to_string(stored),
             "repeat the export; if it fails again, check the disk");
}

}  // namespace

ExportReport export_session(EventFile& file, const std::shared_ptr<const LiveStudy>& study, TeachingCache& cache,
                            const SessionExportOptions& options, const ExportSink& sink) {
  auto told = options;
  told.with_discussions = study->group().discussion.choice.is_held();
  told.with_world_names = !study->spec.world_names.empty();
  Exporter exporter{study, told, sink};
  std::size_t rooms = 0;
  std::size_t events = 0;
  bool is_there = !options.room;
  for (const auto& stored : file.rooms()) {
    if (options.room && stored.number != *options.room) continue;
    is_there = true;
    rooms += room_setup(Json::parse(stored.setup)).is_waiting_list ? 0u : 1u;
    exporter.add(read_history(file, stored, study, cache));
    events += file.count_events(stored.number);
  }
  if (!is_there) {
    refuse_run(ErrorKind::kInvalidInput, "E1618", file.path(), "there is no such room in this session",
               "list the rooms with 'kith session list'");
  }
  const auto report = exporter.finish(file);
  reconcile(file.path(), kSessionsFile, report.rows.at(kSessionsFile), rooms);
  reconcile(file.path(), kEventsFile, report.rows.at(kEventsFile), events);
  return report;
}

}  // namespace kith
