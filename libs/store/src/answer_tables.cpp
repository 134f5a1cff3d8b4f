#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>

#include "kith/domains/file_units.hpp"
#include "kith/explain/examination.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/audit_people.hpp"
#include "room_export.hpp"

namespace kith {
namespace {

struct AnswerTables : RoomExport {
  void write_tests() const {
    for (const auto& test : given_answers()) {
      const auto* answer = test.answer;
      const auto* lesson_row = answer != nullptr ? &history.lessons[answer->lesson] : history.lesson_of(test.period);
      if (lesson_row == nullptr || test.test >= lesson_row->lesson.tests.size()) continue;
      const auto& lesson = lesson_row->lesson;
      const auto place = study.atlas->id(lesson.tests[test.test].start);
      const auto* person = history.person_in(test.period, test.member);
      const bool counts = !lesson_row->is_replaced && person != nullptr && person->seat == test.seat;
      const auto* judged = counts ? history.verdict(test.period, test.member, test.test) : nullptr;
      TestRow row{.session = id(),
                  .period = test.period,
                  .component = lesson.component + 1,
                  .test = test.test + 1,
                  .seat = test.seat,
                  .member = test.member,
                  .type = history.type_of(test.member).value_or(""),
                  .strategy = setup().strategy,
                  .mdp = place.mdp.value(),
                  .mdp_name = if_any(study.atlas->domain().world_name(place.mdp)),
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
        if (judged->answered) row.regret = in_file_units(study.atlas->domain().weights(), judged->regret);
      }
      write.add(tables.tests, row);
      if (answer != nullptr) write_keys(*answer);
    }
  }

  void write_exams() const {
    const auto judge = audit_options(study.spec.teaching, 0.0);
    const auto robot = sha256(study.domain_text);
    for (const auto& one : audits) {
      const auto found = history.seats.find(one.seat);
      if (found == history.seats.end() || found->second.examined.empty()) continue;
      const auto& boards = found->second.examined;
      std::string asked, answers;
      for (const auto& [board, at_us] : boards) {
        const auto place = study.atlas->id(StartIndex{board.start});
        asked += fmt::format("{}{}:{}", asked.empty() ? "" : " ", place.mdp.value(), place.start.value());
        answers += board.right ? "1" : "0";
      }
      const auto at_us = boards.back().second;
      for (const auto& component : one.audit.components) {
        write.add(tables.exams, {.session = id(),
                                 .seat = one.seat,
                                 .member = one.member,
                                 .type = std::string(1, one.type),
                                 .role = if_any(learner_type(study.spec, one.type).label),
                                 .date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time_t{at_us / 1'000'000})),
                                 .at_ms = ms_of(at_us),
                                 .robot = robot,
                                 .component = component.component + 1,
                                 .boards = boards.size(),
                                 .asked = asked,
                                 .answers = answers,
                                 .result = name_of(exam_result(component, judge)),
                                 .all = name_of(exam_result(one.audit, judge))});
      }
    }
  }

  [[nodiscard]] std::string name_of_action(std::size_t action) const {
    const auto& names = study.atlas->domain().action_names();
    return action < names.size() ? names[action] : std::to_string(action);
  }

  [[nodiscard]] std::string path_of(const AnswerRow& answer) const {
    std::string path;
    for (const auto action : answer.actions) path += (path.empty() ? "" : " ") + name_of_action(action);
    return path + (answer.for_ever ? " ..." : "");
  }

  void write_keys(const AnswerRow& answer) const {
    if (!answer.keys.is_array()) return;
    std::size_t number = 0;
    for (const auto& key : answer.keys) {
      ++number;
      if (!key.is_array() || key.size() != 2 || !key[1].is_number_integer()) continue;
      std::string action = "?";
      if (key[0].is_number_unsigned()) action = name_of_action(key[0].get<std::size_t>());
      if (key[0].is_string()) action = printable(key[0].get<std::string>());
      write.add(tables.keys, {.session = id(),
                              .period = answer.period,
                              .test = answer.test + 1,
                              .seat = answer.seat,
                              .key = number,
                              .action = action,
                              .ms = key[1].get<std::int64_t>()});
    }
  }

  void write_questions() const {
    for (const auto& [seat, person] : history.seats) {
      if (history.withdrawn.count(seat) != 0) continue;
      for (const auto& question : study.group().questions) {
        const auto answer = person.answers.find(question.id);
        if (answer == person.answers.end() || answer->is_null()) continue;
        const bool is_hidden = question.kind == GroupQuestion::Kind::kText && !options.with_text;
        QuestionRow row{
            .session = id(), .seat = seat, .question = question.id, .kind = std::string{name_of(question.kind)}};
        if (!is_hidden) row.value = printable(answer->is_string() ? answer->get<std::string>() : answer->dump());
        write.add(tables.questions, row);
      }
    }
  }

  // What each person saw, answered and heard, as `kith fit` reads it. Stand-ins are left out.
  void write_trials() const {
    for (const auto& period : session().history()) {
      for (std::size_t member = 1; member <= period.feedback.verdicts.size(); ++member) {
        const auto& verdicts = period.feedback.verdicts[member - 1];
        const auto* person = history.person_in(period.lesson.period, member);
        if (person == nullptr || !person->is_person || history.withdrawn.count(person->seat) != 0) continue;
        const auto seat = person->seat;
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

  void write_discussions() const {
    for (const auto& past : session().history()) {
      const auto& feedback = past.feedback;
      for (std::size_t m = 0; m < past.revised.size(); ++m) {
        const auto* person = history.person_in(past.lesson.period, m + 1);
        const auto seat = person == nullptr || !person->is_person ? 0 : person->seat;
        if (history.withdrawn.count(seat) != 0) continue;
        for (std::size_t t = 0; t < feedback.verdicts[m].size(); ++t) {
          const bool changed = !past.revised[m].empty() && past.revised[m][t] != past.answers[m][t];
          write.add(tables.discussions, {.session = id(),
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

  void write_trial(std::size_t seat, const Lesson& lesson, const char* type, std::optional<bool> correct,
                   const std::vector<HalfSpace>& constraints) const {
    const auto num_features = study.spec.num_features;
    TrialRow row{.user_id = std::to_string(seat),
                 .group = id(),
                 .domain = study.atlas->domain().id(),
                 .kc_id = std::to_string(lesson.component + 1),
                 .interaction_type = type,
                 .mdp_parameters = Json{{"constraints", to_json(constraints, num_features)},
                                        {"prior", to_json(study.atlas->domain().prior(), num_features)}}
                                       .dump()};
    if (correct) row.is_opt_response = *correct ? "1" : "0";
    write.add(tables.trials, row);
  }
};

}  // namespace

std::vector<ExportedAnswer> RoomExport::given_answers() const {
  std::vector<ExportedAnswer> rows;
  for (const auto& answer : history.answers) {
    rows.push_back({.period = answer.period,
                    .test = answer.test,
                    .seat = answer.seat,
                    .member = answer.member,
                    .answer = &answer});
  }
  // Of stand-ins, and of people who did not answer in time.
  const auto is_there = [&](std::size_t seat, std::size_t period, std::size_t test) {
    return std::any_of(history.answers.begin(), history.answers.end(), [&](const AnswerRow& answer) {
      return answer.seat == seat && answer.period == period && answer.test == test && !history.is_void(answer);
    });
  };
  for (const auto& person : history.people) {
    for (const auto& period : person.periods) {
      if (period.is_exam()) continue;
      for (std::size_t test = 0; test < period.verdicts.size(); ++test) {
        if (is_there(person.seat, period.period, test)) continue;
        rows.push_back({.period = period.period,
                        .test = test,
                        .seat = person.seat,
                        .member = person.member + 1,
                        .answer = nullptr});
      }
    }
  }
  std::erase_if(rows, [&](const auto& row) { return history.withdrawn.count(row.seat) != 0; });
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.key() < b.key(); });
  return rows;
}

void write_answers(const RoomExport& room) {
  const AnswerTables tables{room};
  tables.write_tests();
  if (room.options.with_discussions) tables.write_discussions();
  if (room.options.with_exams) tables.write_exams();
  tables.write_questions();
  tables.write_trials();
}

}  // namespace kith
