#include "kith/study/exam_rehearsal.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "kith/core/parallel.hpp"
#include "kith/learners/people_not_as_assumed.hpp"
#include "kith/study/audit_people.hpp"
#include "kith/study/observed_team.hpp"
#include "kith/study/team_run.hpp"
#include "kith/teaching/cache_pool.hpp"

namespace kith {
namespace {

constexpr const char* kTeacherOfRehearsals = "plan";
constexpr double kMostlyWrong = 0.5;

// Keeps the person as lessons leave them.
class AfterTeaching final : public TeamObserver {
 public:
  std::unique_ptr<Learner> person;

  void on_session(const Session& /*session*/, std::span<const std::size_t> /*members*/) override {}
  void on_lesson(const Session& /*session*/, const Lesson& /*lesson*/, const Learners& /*learners*/) override {}
  void on_feedback(const Session& /*session*/, const Lesson& /*lesson*/,
                   const std::vector<Learner::Response>& /*responses*/, const Feedback& /*feedback*/,
                   const Learners& /*learners*/) override {}
  void on_end(const Session& /*session*/, const Learners& learners) override { person = learners.front()->clone(); }
};

// One person. @param number  from 1; the types of the study come in turn.
RehearsedKind rehearse_person(TeachingCache& cache, const StudySpec& spec, std::size_t number) {
  const auto& types = spec.learner_types;
  const std::string letter(1, types[number % types.size()].letter);
  AfterTeaching after;
  const auto record = run_team(cache.atlas(), cache, spec, {0, kTeacherOfRehearsals, letter, number, number}, &after);
  auto periods = observed_people(cache.atlas(), record).front();
  const auto options = audit_options(spec.teaching, 0.0);
  const auto& person = *after.person;
  Examination exam{cache, options, std::move(periods), RandomStream{1}.split("exam").split(number)};
  const Auditor auditor{cache, options};
  const bool answers_otherwise = person.belief() != nullptr && !person.answers_as_believed();
  RehearsedKind result{.kind = std::string{types.front().model->kind}, .people = 1};
  std::vector<double> levels;  // how often the person satisfies each component
  for (std::size_t k = 0; k < cache.atlas().knowledge_components().size(); ++k) {
    levels.push_back(answers_otherwise ? 0.0 : person.mass_in(auditor.constraints_of(k)));
    result.understood += levels.back() >= options.level.enough ? 1u : 0u;
    if (levels.back() < kMostlyWrong) result.mistaken = 1;
  }
  for (const auto length : kExamLengths) {
    while (exam.num_boards() < length) {
      const auto start = exam.next();
      if (!start) break;
      const auto response = person.answer(cache.behaviours(), {&*start, 1}, exam.periods().size() + 1);
      exam.take(*start, response.answers.front());
    }
    auto& findings = result.findings.emplace_back();
    for (const auto& audit : exam.audit().components) {
      if (audit.understanding != Understanding::kUnderstands) continue;
      const double level = levels[audit.component];
      if (level >= options.level.enough) {
        ++findings.rightly;
      } else {
        (level < kMostlyWrong ? findings.wrongly : findings.nearly) = 1;
      }
    }
  }
  result.boards = exam.num_boards();
  return result;
}

void add_person(RehearsedKind& sum, const RehearsedKind& person) {
  sum.kind = person.kind;
  sum.people += person.people;
  sum.mistaken += person.mistaken;
  sum.understood += person.understood;
  sum.boards += person.boards;
  sum.findings.resize(kExamLengths.size());
  for (std::size_t i = 0; i < kExamLengths.size(); ++i) {
    sum.findings[i].wrongly += person.findings[i].wrongly;
    sum.findings[i].nearly += person.findings[i].nearly;
    sum.findings[i].rightly += person.findings[i].rightly;
  }
}

}  // namespace

std::vector<RehearsedKind> rehearse_exam(const Atlas& atlas, const StudySpec& study,
                                         const ExamRehearsalOptions& options) {
  constexpr std::size_t kLessons = 12;
  std::vector<StudySpec> specs{study};
  for (const auto& model : people_not_as_assumed()) {
    const bool imitates = &model == &people_not_as_assumed().back();
    if (imitates && !atlas.find_tables()) continue;
    specs.push_back(study);
    for (auto& type : specs.back().learner_types) type.model = &model;
  }
  for (auto& spec : specs) {
    spec.strategies = {strategy_named(kTeacherOfRehearsals)};
    spec.record = RecordLevel::kPeriod;
    spec.exam = ExamLevel::kNone;
    spec.teaching.max_periods = kLessons;
  }
  std::vector<RehearsedKind> people(specs.size() * options.people);
  CachePool caches{atlas};
  const bool all = for_each_index(
      people.size(), {.threads = options.threads, .on_progress = options.on_progress}, [&](std::size_t i) {
        auto cache = caches.take();
        people[i] = rehearse_person(*cache, specs[i / options.people], i % options.people + 1);
        caches.give_back(std::move(cache));
      });
  std::vector<RehearsedKind> kinds;
  if (!all) return kinds;
  kinds.resize(specs.size());
  for (std::size_t i = 0; i < people.size(); ++i) add_person(kinds[i / options.people], people[i]);
  kinds.front().kind = "learns as assumed";
  return kinds;
}

Json rehearsal_json(const Atlas& atlas, const std::vector<RehearsedKind>& kinds, const std::string& program) {
  Json json{{"schema", "kith.exam-rehearsal/1"},
            {"program", program},
            {"domain", atlas.domain().id()},
            {"boards", kExamLengths},
            {"kinds", Json::array()}};
  for (const auto& kind : kinds) {
    Json row{{"kind", kind.kind},
             {"people", kind.people},
             {"mistaken", kind.mistaken},
             {"components_understood", kind.understood},
             {"boards_asked", kind.boards},
             {"said_rightly", Json::array()},
             {"said_nearly", Json::array()},
             {"said_wrongly", Json::array()}};
    for (const auto& findings : kind.findings) {
      row["said_rightly"].push_back(findings.rightly);
      row["said_nearly"].push_back(findings.nearly);
      row["said_wrongly"].push_back(findings.wrongly);
    }
    json["kinds"].push_back(std::move(row));
  }
  return json;
}

}  // namespace kith
