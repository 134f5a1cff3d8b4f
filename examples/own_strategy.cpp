// A strategy of one's own: teach for whoever gave the most wrong answers so far. It is a class and a row of the kind
// that kith's own strategies are; no library is touched.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "kith/domains/domain_file.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/session.hpp"

namespace {

class ForMostWrong : public kith::Strategy {
 public:
  [[nodiscard]] std::unique_ptr<kith::Strategy> clone() const override { return std::make_unique<ForMostWrong>(*this); }

  [[nodiscard]] kith::UnitProposal propose(const kith::TeachingView& view, kith::UnitSelector& select,
                                           kith::RandomStream random) override {
    const auto seat = most_wrong(view);
    return {kith::SourceBelief::of_member(seat), select.for_belief(view.belief.member(seat), random)};
  }

 private:
  // Ties are broken by the person, not by the seat: then seats do not matter.
  static std::size_t most_wrong(const kith::TeachingView& view) {
    std::vector<std::size_t> wrong(view.belief.num_members());
    for (const auto& period : view.history) {
      for (std::size_t i = 0; i < wrong.size(); ++i) {
        wrong[i] += static_cast<std::size_t>(std::count_if(period.feedback.verdicts[i].begin(),
                                                           period.feedback.verdicts[i].end(),
                                                           [](const auto& verdict) { return !verdict.correct; }));
      }
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < wrong.size(); ++i) {
      const bool tie = wrong[i] == wrong[best];
      if (tie ? view.tie_breaks[i] < view.tie_breaks[best] : wrong[i] > wrong[best]) best = i;
    }
    return best;
  }
};

kith::TeamBeliefNeeds beliefs_about_members(const kith::ParameterValues&) { return {.members = true, .rules = {}}; }
std::unique_ptr<kith::Strategy> make(const kith::ParameterValues&) { return std::make_unique<ForMostWrong>(); }

const kith::StrategyKind kMostWrong{"most-wrong", "teach for whoever gave the most wrong answers",
                                    beliefs_about_members, make};

// Member 1 does not answer in the first period, member 3 in none of the others; else everybody gives the robot's path.
std::vector<std::vector<kith::Answer>> answers_to(const kith::Session& session) {
  const auto& lesson = session.lesson();
  const std::size_t silent = lesson.period == 1 ? 0 : 2;
  std::vector<std::vector<kith::Answer>> answers(session.num_members());
  for (const auto& test : lesson.tests) {
    for (std::size_t i = 0; i < answers.size(); ++i) {
      answers[i].push_back(i == silent ? kith::Answer{} : session.atlas().feature_counts(test.start));
    }
  }
  return answers;
}

}  // namespace

int main() {
  const kith::Atlas atlas{kith::load_domain("item-delivery")};
  kith::TeachingCache cache{atlas};
  const kith::RandomStream random{1};
  const std::vector<kith::RandomStream> persons{random.split(1), random.split(2), random.split(3)};

  kith::TeachingOptions options;
  options.max_periods = 4;
  kith::Session session{cache, options, {"most-wrong", kMostWrong, {}}, persons, random.split("teacher")};
  while (session.propose(cache)) {
    const auto& lesson = session.lesson();
    std::printf("period %zu: chosen for member %zu, %zu demonstrations, %zu tests\n", lesson.period,
                lesson.source.member + 1, lesson.demonstrations.size(), lesson.tests.size());
    (void)session.submit(answers_to(session));
  }
}
