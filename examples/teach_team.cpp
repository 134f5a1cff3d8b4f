// Three simulated people are taught what the item delivery robot wants, one interaction period after the other.
#include <cstdio>
#include <vector>

#include "kith/domains/domain_file.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/teaching/session.hpp"

namespace {

void print(const kith::Session& session, const kith::Learners& people) {
  const auto& period = session.history().back();
  const auto& component = session.atlas().knowledge_components()[period.lesson.component];
  std::printf("period %2zu: %-20s right:", session.periods(), component.name.c_str());
  for (const bool right : period.feedback.all_correct) std::printf(" %s", right ? "yes" : "no ");
  std::printf("  knowledge:");
  for (const auto& one : people) std::printf(" %.2f", one->mass_in(session.atlas().policy_bec_half_spaces()));
  std::printf("\n");
}

}  // namespace

int main() {
  const kith::Atlas atlas{kith::load_domain("item-delivery")};
  kith::TeachingCache cache{atlas};
  const kith::RandomStream random{1};

  const kith::LearnerModel& model = kith::bayesian_model();
  const kith::ParameterValues parameters{
      model.parameters};  // the defaults; parameters.set("ability.mean", 0.8) changes one
  const kith::LearnerStart start{.cover = [&](std::size_t num_points) -> const kith::PriorCover& {
    return cache.cover(atlas.prior_cone(), num_points);
  }};
  std::vector<kith::RandomStream> persons;  // what the teacher draws for each person
  kith::Learners people;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    const auto person = random.split("person").split(i);
    const auto traits = model.draw(parameters, person.split("parameters"));
    people.push_back(model.make(parameters, traits, start, person.split("learner")));
    persons.push_back(person.split("teacher"));
  }

  kith::Session session{cache, {}, kith::strategy_named("common"), persons, random.split("teacher")};
  while (session.propose(cache)) {
    kith::run_period(session, cache, people);
    print(session, people);
  }
}
