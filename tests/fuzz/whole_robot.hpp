#pragma once

#include <string>

#include "fuzzing.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/audit.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/target.hpp"
#include "kith/teaching/session.hpp"

namespace kith::fuzzing {

/// Everything that the commands find, curriculum, ask, teach and audit do with a domain, if it is small. It ends, or
/// with an error that people can make sense of.
class WholeRobot {
 public:
  static void use(const Domain& domain) {
    const bool is_small = domain.num_features() >= 2 && domain.num_features() <= 4 && domain.num_mdps() <= 8 &&
                          domain.num_starts() <= 150;
    if (!is_small) return;
    try {
      WholeRobot robot{domain};
      robot.find();
      robot.ask();
      robot.make_lessons();
      robot.teach();
    } catch (const Error& error) {
      require(error.kind() == ErrorKind::kInfeasible, "what is valid can be used, or not at all", error.what());
    }
  }

 private:
  explicit WholeRobot(const Domain& domain) : atlas_{domain} {
    options_.filter.particles = 40;
    options_.max_periods = 3;
  }

  void find() const {
    for (const auto& isolated_constraint : isolated_constraints(atlas_)) {
      for (const auto purpose : {Purpose::kTeach, Purpose::kTest}) {
        const auto found = simplest_isolating(atlas_, isolated_constraint.constraint, purpose);
        require(found.has_value() ==
                    ((purpose == Purpose::kTeach ? isolated_constraint.teaching : isolated_constraint.testing) > 0),
                "what is counted is found");
      }
    }
  }

  void ask() const {
    for (const auto& feature : atlas_.domain().feature_names()) {
      for (const std::string words : {"when ", "where not ", "why ", "why not ", "how much ", "what if no "}) {
        try {
          require(!answer_question(atlas_, words + feature).text.empty(), "a question has an answer");
        } catch (const Error& error) {
          require(error.kind() == ErrorKind::kInvalidInput, "or none that people can have", error.what());
        }
      }
    }
  }

  void make_lessons() const {
    CurriculumOptions options;
    options.teaching = options_;
    options.runs = 2;
    options.beliefs = 20;
    try {
      for (const auto& component : make_curriculum(atlas_, options).components) {
        require(!component.demonstrations.empty(), "a lesson shows something");
        for (const auto& shown : component.demonstrations) {
          require(!shown.conveys.empty() && !shown.reason.empty(), "and says why");
          require(!atlas_.trajectory(shown.start).actions.empty(), "what it shows can be seen");
        }
        for (const auto& test : component.tests) {
          require(test.share_right >= 0.0 && test.share_right <= 1.0, "a share is one");
        }
      }
    } catch (const Error& error) {
      require(error.kind() == ErrorKind::kInfeasible, "lessons, or nothing to teach", error.what());
    }
  }

  // The path after the last possible action: as good as the robot's, or worse.
  [[nodiscard]] Answer another_answer(StartIndex start) const {
    const auto id = atlas_.id(start);
    return atlas_.deviation_counts(start, atlas_.domain().mdp(id.mdp).choices(id.start).size() - 1);
  }

  // Two people, one of whom is always right.
  void teach() const {
    TeachingCache cache{atlas_};
    Session session{cache, options_, strategy_named("common"), {RandomStream{1}, RandomStream{2}}, RandomStream{3}};
    while (session.propose(cache)) {
      std::vector<std::vector<Answer>> answers(2);
      for (const auto& test : session.lesson().tests) {
        answers[0].emplace_back(atlas_.feature_counts(test.start));
        answers[1].push_back(another_answer(test.start));
      }
      const auto feedback = session.submit(answers);
      for (const auto& verdict : feedback.verdicts[0]) require(verdict.correct, "the robot's own path is right");
      for (const auto& verdict : feedback.verdicts[1]) require(verdict.regret >= 0.0, "no path is better");
    }
    AuditOptions options;
    options.bank.filter.particles = 40;
    Auditor auditor{cache, options};
    for (std::size_t member = 0; member < 2; ++member) {
      const auto person = auditor.audit(observed_periods(session.history(), member), RandomStream{4});
      for (const auto& audit : person.components) {
        require(audit.level.probability >= 0.0 && audit.level.probability <= 1.0 + 1e-9, "a probability is one");
        require(audit.level.low <= audit.level.mean + 1e-9 && audit.level.mean <= audit.level.high + 1e-9,
                "a mean lies in its interval");
        require(audit.correct <= audit.tests, "not more is right than was asked");
      }
    }
  }

  Atlas atlas_;
  TeachingOptions options_{};
};

}  // namespace kith::fuzzing
