#pragma once

#include <span>
#include <vector>

#include "kith/explain/audit.hpp"
#include "kith/study/team_run.hpp"

namespace kith::testing {

/// Keeps how often each member satisfies all constraints of each component at the end.
class TrueLevels : public TeamObserver {
 public:
  explicit TrueLevels(const Auditor& auditor) : auditor_{auditor} {}
  std::vector<std::vector<double>> levels;  // per member and component

  void on_session(const Session& /*session*/, std::span<const std::size_t> /*members*/) override {}
  void on_lesson(const Session& /*session*/, const Lesson& /*lesson*/, const Learners& /*learners*/) override {}
  void on_feedback(const Session& /*session*/, const Lesson& /*lesson*/,
                   const std::vector<Learner::Response>& /*responses*/, const Feedback& /*feedback*/,
                   const Learners& /*learners*/) override {}
  void on_end(const Session& session, const Learners& learners) override {
    for (const auto& learner : learners) {
      auto& row = levels.emplace_back();
      for (std::size_t k = 0; k < session.components().size(); ++k) {
        row.push_back(learner->mass_in(auditor_.constraints_of(k)));
      }
    }
  }

 private:
  const Auditor& auditor_;
};

}  // namespace kith::testing
