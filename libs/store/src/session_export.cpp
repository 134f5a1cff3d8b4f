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
// CSV cells hold no zero bytes.
std::string printable(std::string text) {
  std::erase(text, '\0');
  return text;
}

// One row of tests.csv: an answer of a person, or of a stand-in, whose paths are not kept.
struct TestRow {
  std::size_t period = 0;
  std::size_t test = 0;  // from 0
  std::size_t seat = 0;
  std::size_t member = 0;
  const AnswerRow* answer = nullptr;
  [[nodiscard]] auto key() const { return std::tuple{period, test, member, seat}; }
};

// The writers of all tables; hashes what they write.
class Tables {
 public:
  Tables(const SessionExportOptions& options, const ExportSink& sink) : sink_{sink} {
    for (auto& table : export_tables(options)) {
      const auto file = table.file;
      hashes_.try_emplace(file);
      writers_.try_emplace(file, std::move(table.columns), [this, file](std::string_view piece) { put(file, piece); });
    }
  }
  CsvWriter& operator[](const char* file) { return writers_.at(file); }

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
      : study_{study}, atlas_{*study->atlas}, options_{options}, tables_{options, sink} {}

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
    return tables_.finish(export_tables(options_), file.identity().study, about(file));
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
    auto& row = tables_[kSessionsFile];
    row.text(id()).text(setup().strategy).text(setup().composition).integer(setup().replicate);
    row.integer(setup().composition.size());
    row.integer(setup().composition.size() - static_cast<std::size_t>(simulated));
    row.integer(ms_of(history_->stored.created_us)).integer(ms_if_any(history_->started_us));
    row.integer(ms_if_any(history_->events.empty() ? 0 : history_->events.back().at_us));
    row.text(kStages[static_cast<std::size_t>(history_->room->stage())]).text_or_missing(if_any(history_->ended));
    row.boolean(session().status() == SessionStatus::kComplete).integer(past.size()).integer(demonstrations);
    row.integer(tests);
    row.real(answered == 0 ? std::nullopt : std::optional{static_cast<double>(right) / static_cast<double>(answered)});
    row.integer(learned).real(is_known ? std::optional{knowledge} : std::nullopt).text(history_->replayed.digest);
    row.end_row();
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
    auto& row = tables_[kParticipantsFile];
    row.text(id()).integer(seat);
    if (person.member) {
      row.integer(*person.member);
    } else {
      row.missing();
    }
    const auto group = setup().is_waiting_list ? RoomSetup{} : setup();
    row.text_or_missing(type_of(person.member)).text_or_missing(if_any(group.strategy));
    row.text_or_missing(if_any(group.composition))
        .boolean(person.simulated)
        .integer(ms_if_any(person.joined_us))
        .text_or_missing(if_any(person.consent));
    const auto stage = stage_of(seat);
    row.text_or_missing(if_any(stage)).integer(person.times_away).real(static_cast<double>(person.away_us) / 1e6);
    row.integer(tests).integer(right);
    row.real(tests == 0 ? std::nullopt : std::optional{static_cast<double>(right) / static_cast<double>(tests)});
    const bool is_last = person.member && history_->seat_of(*person.member) == seat;
    row.real(is_last ? belief_in(*person.member) : std::nullopt);
    const auto& screened = person.screened;
    const auto passed = static_cast<std::size_t>(std::count(screened.begin(), screened.end(), true));
    const bool is_screened = !screened.empty() && screened.size() == study_->screening.size();
    row.real(is_screened ? std::optional{screening_estimate(passed, screened.size())} : std::nullopt);
    if (options_.with_names) {
      row.text_or_missing(if_any(printable(person.name)));
      row.text_or_missing(person.query.empty() ? std::nullopt : std::optional{printable(person.query.dump())});
      const bool has_code = stage == "debrief" || stage == "ended" || stage == "replaced";
      row.text_or_missing(has_code ? std::optional{completion_code(*study_, setup().salt, setup().id, seat)}
                                   : std::nullopt);
    }
    row.end_row();
  }

  void write_period(const LessonRow& lesson_row) {
    const auto& lesson = lesson_row.lesson;
    const auto& past = session().history();
    const bool is_finished = lesson.period <= past.size();
    auto& row = tables_[kPeriodsFile];
    row.text(id()).integer(lesson.period).integer(lesson.component + 1);
    row.text(lesson.source.is_member() ? "member " + std::to_string(lesson.source.member + 1) : lesson.source.rule);
    row.integer(ms_of(lesson_row.chosen_us)).integer(lesson.demonstrations.size()).integer(lesson.tests.size());
    if (is_finished) {
      const auto& feedback = past[lesson.period - 1].feedback;
      std::size_t active = 0;
      bool all_right = true;
      for (std::size_t i = 0; i < feedback.verdicts.size(); ++i) {
        if (feedback.verdicts[i].empty()) continue;
        ++active;
        all_right = all_right && feedback.all_correct[i];
      }
      row.integer(active).boolean(all_right);
    } else {
      row.missing().missing();
    }
    row.real(lesson.gain).real(lesson.area_sr).text(lesson_row.digest);
    row.end_row();
  }

  [[nodiscard]] std::vector<TestRow> test_rows() const {
    std::vector<TestRow> rows;
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
    std::stable_sort(rows.begin(), rows.end(), [](const TestRow& a, const TestRow& b) { return a.key() < b.key(); });
    return rows;
  }

  void write_tests() {
    for (const auto& test : test_rows()) {
      const auto* answer = test.answer;
      const auto* lesson_row =
          answer != nullptr ? &history_->lessons[answer->lesson] : history_->lesson_of(test.period);
      if (lesson_row == nullptr || test.test >= lesson_row->lesson.tests.size()) continue;
      const auto& lesson = lesson_row->lesson;
      const auto place = atlas_.id(lesson.tests[test.test].demo);
      const auto* judged = lesson_row->is_replaced ? nullptr : verdict(test.period, test.member, test.test);
      auto& row = tables_[kTestsFile];
      row.text(id()).integer(test.period).integer(lesson.component + 1).integer(test.test + 1).integer(test.seat);
      row.integer(test.member).text(type_of(test.member).value_or("")).text(setup().strategy);
      row.integer(place.mdp.value()).integer(place.start.value());
      if (answer != nullptr) {
        row.text(path_of(*answer)).integer(answer->actions.size());
      } else {
        row.missing().integer(std::size_t{0});
      }
      row.boolean(judged != nullptr ? std::optional{judged->correct} : std::nullopt);
      row.real(judged != nullptr && judged->answered ? std::optional{judged->regret} : std::nullopt);
      row.real(answer != nullptr && answer->ms ? std::optional{static_cast<double>(*answer->ms) / 1000.0}
                                               : std::nullopt);
      row.integer(ms_of(answer != nullptr ? answer->at_us : lesson_row->chosen_us));
      row.end_row();
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
      auto& row = tables_[kKeysFile];
      row.text(id()).integer(answer.period).integer(answer.test + 1).integer(answer.seat).integer(number);
      row.text(key[0].is_number_unsigned() ? name_of_action(key[0].get<std::size_t>())
               : key[0].is_string()        ? printable(key[0].get<std::string>())
                                           : "?");
      row.integer(key[1].get<std::int64_t>());
      row.end_row();
    }
  }

  void write_questions() {
    for (const auto& [seat, person] : history_->seats) {
      for (const auto& question : study_->group().questions) {
        const auto answer = person.answers.find(question.id);
        if (answer == person.answers.end() || answer->is_null()) continue;
        const bool is_hidden = question.kind == GroupQuestion::Kind::kText && !options_.with_text;
        auto& row = tables_[kQuestionsFile];
        row.text(id()).integer(seat).text(question.id).text(name_of(question.kind));
        if (is_hidden) {
          row.missing();
        } else {
          row.text(printable(answer->is_string() ? answer->get<std::string>() : answer->dump()));
        }
        row.end_row();
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
          auto& row = tables_[kDiscussionsFile];
          row.text(id()).integer(past.lesson.period).integer(past.lesson.component + 1).integer(t + 1);
          row.integer(seat == 0 ? std::nullopt : std::optional{static_cast<std::int64_t>(seat)}).integer(m + 1);
          row.boolean(feedback.verdicts[m][t].correct).boolean(feedback.final_verdicts(m)[t].correct).boolean(changed);
          row.end_row();
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
    const auto dimension = study_->spec.num_features;
    auto& row = tables_[kTrialsFile];
    row.text(std::to_string(seat)).text(id()).text(atlas_.domain().id()).text("cl");
    row.text(std::to_string(lesson.component + 1)).text(type);
    row.text_or_missing(correct ? std::optional<std::string>{*correct ? "1" : "0"} : std::nullopt);
    row.text(Json{{"constraints", to_json(constraints, dimension)}}.dump());
    row.end_row();
  }

  void write_beliefs() {
    const auto detail = history_->room->view({.role = Viewer::Role::kObserver, .seat = 0}, 0)["room"];
    for (const auto& point : detail["curves"]) {
      for (const auto& [name, mass] : point["p_bec"].items()) {
        constexpr std::string_view kMember{"member "};
        auto& row = tables_[kBeliefsFile];
        row.text(id()).integer(point["period"].get<std::size_t>()).text(name);
        if (name.compare(0, kMember.size(), kMember) == 0) {
          row.integer(static_cast<std::size_t>(std::stoul(name.substr(kMember.size()))));
        } else {
          row.missing();
        }
        row.real(mass.get<double>());
        row.end_row();
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
    auto& row = tables_[kEventsFile];
    row.text(id()).integer(event.seq).integer(event.at_us).text(event.actor).text(event.type);
    row.text(printable(body.dump()));
    row.end_row();
  }

  const std::shared_ptr<const LiveStudy>& study_;
  const Atlas& atlas_;
  const SessionExportOptions& options_;
  Tables tables_;
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
