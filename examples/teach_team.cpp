// Three simulated people are taught what the item delivery robot wants, one interaction period after the other.
#include <cstdio>
#include <vector>

#include "kith/domains/domain_file.hpp"
#include "kith/learners/simulated_learner.hpp"
#include "kith/teaching/session.hpp"

namespace {

// Everybody watches the demonstrations, answers the tests and hears what would have been right.
void run_period(kith::Session& session, kith::TeachingCache& cache, std::vector<kith::SimulatedLearner>& people) {
  const kith::Lesson lesson = session.lesson();
  session.show();
  std::vector<kith::HalfSpace> conveyed;
  for (const auto& shown : lesson.demonstrations) {
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  std::vector<kith::DemoIndex> tests;
  for (const auto& test : lesson.tests) tests.push_back(test.demo);
  for (std::size_t member = 0; member < people.size(); ++member) {
    people[member].watch(conveyed, lesson.period);
    session.answer(member, people[member].answer(cache.behaviours(), tests, lesson.period).answers);
  }
  session.close_tests();
  const kith::Feedback feedback = session.give_feedback();
  for (std::size_t member = 0; member < people.size(); ++member) {
    people[member].hear_feedback(feedback.all_correct[member], feedback.half_spaces, lesson.period);
  }
}

void print(const kith::Session& session, const std::vector<kith::SimulatedLearner>& people) {
  const auto& period = session.history().back();
  const auto& component = session.atlas().knowledge_components()[period.lesson.component];
  std::printf("period %2zu: %-20s right:", session.periods(), component.name.c_str());
  for (const bool right : period.feedback.all_correct) std::printf(" %s", right ? "yes" : "no ");
  std::printf("  knowledge:");
  for (const auto& one : people) {
    std::printf(" %.2f", one.belief().mass_in(session.atlas().policy_bec_half_spaces()));
  }
  std::printf("\n");
}

}  // namespace

int main() {
  const kith::Atlas atlas{kith::load_domain("item-delivery")};
  kith::TeachingCache cache{atlas};
  const kith::RandomStream random{1};

  std::vector<kith::RandomStream> persons;  // what the teacher draws for each person
  std::vector<kith::SimulatedLearner> people;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    const auto person = random.split("person").split(i);
    const auto parameters = kith::draw_learner(kith::Population{}, person.split("parameters"));
    const kith::ParticleBelief belief{cache.cover(atlas.prior_cone(), 1000), kith::FilterOptions{}};
    persons.push_back(person.split("teacher"));
    people.emplace_back(atlas, belief, parameters, kith::LikelihoodForm::kDiscontinuous, person.split("learner"));
  }

  kith::Session session{cache, {}, kith::strategy_named("common"), persons, random.split("teacher")};
  std::size_t component = 0;
  while (session.propose(cache)) {
    if (session.lesson().component != component) {
      component = session.lesson().component;
      for (auto& one : people) one.begin_component();
    }
    run_period(session, cache, people);
    print(session, people);
  }
}
