// A rule of aggregation of one's own: a belief about what most members know. It is a function and a row of the kind
// that kith's own rules are; no library is touched.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kith/belief/aggregation.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/session.hpp"

namespace {

// Updates the belief with every half-space that the answers of more than half of the members show. A half-space counts
// as often as more than half of them show it at least.
std::vector<std::size_t> observe_majority(kith::ParticleBelief& belief, const kith::TeamResponses& responses,
                                          kith::RandomStream random) {
  std::map<kith::HalfSpace, std::vector<std::size_t>> times;  // per member who shows it
  for (const auto& list : responses.lists) {
    std::map<kith::HalfSpace, std::size_t> own;
    for (const auto& half_space : list) ++own[half_space];
    for (const auto& [half_space, n] : own) times[half_space].push_back(n);
  }
  const auto half = responses.lists.size() / 2;
  std::vector<kith::HalfSpace> shown;
  for (auto& [half_space, counts] : times) {
    std::sort(counts.begin(), counts.end(), std::greater<>{});
    if (counts.size() > half) shown.insert(shown.end(), counts[half], half_space);
  }
  belief.observe(shown, responses.likelihood, random);
  return {};  // nobody is left out
}

const kith::AggregationRule kMajority{"majority", "what more than half of the members know", observe_majority};

// Members 1 and 2 give the robot's path, member 3 does not answer.
std::vector<std::vector<kith::Answer>> answers_to(const kith::Session& session) {
  std::vector<std::vector<kith::Answer>> answers(session.num_members());
  for (const auto& test : session.lesson().tests) {
    for (std::size_t i = 0; i < answers.size(); ++i) {
      answers[i].push_back(i == 2 ? kith::Answer{} : session.atlas().feature_counts(test.start));
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
  options.rules.push_back(kMajority);
  options.keep_rules = true;  // also those that the strategy does not read
  kith::Session session{cache, options, kith::strategy_named("joint"), persons, random.split("teacher")};
  while (session.propose(cache)) {
    (void)session.submit(answers_to(session));
    std::printf("period %zu:", session.periods());
    for (const auto& rule : options.rules) {
      const auto& belief = session.belief().aggregate(rule.name);
      std::printf("  %s %.2f", std::string{rule.name}.c_str(), belief.mass_in(atlas.policy_bec_half_spaces()));
    }
    std::printf("\n");
  }
}
