#include "kith/explain/runs.hpp"

#include <algorithm>
#include <map>

#include "kith/core/assert.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

// Follows the robot's policy; what it does in a state is looked up once.
class Runner {
 public:
  Runner(const Atlas& atlas, MdpIndex world) : atlas_{atlas}, world_{world}, mdp_{atlas.domain().mdp(world)} {}

  PolicyRun run(StateIndex s, RandomStream& random) {
    PolicyRun result{{{s}, {}}, IntegerVector(mdp_.num_features()), false};
    for (std::size_t t = 0; t < atlas_.domain().max_steps() && !mdp_.is_terminal(s); ++t) {
      const auto& choice = choice_in(s);
      const auto& outcome = drawn(choice, random);
      const auto features = mdp_.features(outcome);
      for (std::size_t k = 0; k < features.size(); ++k) result.times[k] += features[k] != 0.0 ? 1 : 0;
      s = outcome.next;
      result.path.actions.push_back(choice.action);
      result.path.states.push_back(s);
    }
    result.has_ended = mdp_.is_terminal(s);
    return result;
  }

  // Whether some outcome was left to chance so far.
  [[nodiscard]] bool met_chance() const { return met_chance_; }

 private:
  const Choice& choice_in(StateIndex s) {
    const auto known = choices_.find(s);
    if (known != choices_.end()) return *known->second;
    const auto choices = mdp_.choices(s);
    const auto choice = std::ranges::find(choices, atlas_.action(atlas_.index({world_, s})), &Choice::action);
    KITH_ASSERT(choice != choices.end());
    met_chance_ = met_chance_ || mdp_.outcomes(*choice).size() > 1;
    return *choices_.emplace(s, &*choice).first->second;
  }

  const Outcome& drawn(const Choice& choice, RandomStream& random) const {
    const auto outcomes = mdp_.outcomes(choice);
    if (outcomes.size() == 1) return outcomes.front();
    double left = uniform01(random);
    for (const auto& outcome : outcomes) {
      if (left < outcome.probability) return outcome;
      left -= outcome.probability;
    }
    return *std::ranges::max_element(outcomes, {}, &Outcome::probability);  // rounding
  }

  const Atlas& atlas_;
  MdpIndex world_;
  const Mdp& mdp_;
  std::map<StateIndex, const Choice*> choices_;
  bool met_chance_ = false;
};

constexpr std::size_t kMostDraws = 20;  // for each run that is wanted

// Whether the robot itself would act like this, as far as inferred weights explain what it does.
bool is_explained(const Domain& domain, MdpIndex world, const PolicyRun& run) {
  if (!domain.inferred()) return true;
  const auto& strange = domain.inferred()->not_explained;
  return std::ranges::none_of(run.path.states, [&](StateIndex s) {
    return std::binary_search(strange.begin(), strange.end(), StartId{world, s});
  });
}

}  // namespace

std::vector<PolicyRun> several_runs(const Atlas& atlas, StartIndex start, std::size_t n, RandomStream& random) {
  const auto id = atlas.id(start);
  Runner runner{atlas, id.mdp};
  std::vector<PolicyRun> runs;
  for (std::size_t i = 0; i < kMostDraws * n && runs.size() < n; ++i) {
    auto run = runner.run(id.start, random);
    if (!runner.met_chance()) return {};  // nor would any other run
    if (is_explained(atlas.domain(), id.mdp, run)) runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<PolicyRun> typical_runs(std::vector<PolicyRun> runs) {
  std::ranges::stable_sort(runs, {}, [](const PolicyRun& run) { return run.path.actions.size(); });
  std::vector<std::size_t> chosen;
  for (const std::size_t tenths : {5u, 3u, 7u, 1u, 9u}) {
    const auto i = tenths * runs.size() / 10;
    if (i < runs.size() && std::ranges::find(chosen, i) == chosen.end()) chosen.push_back(i);
  }
  std::vector<PolicyRun> typical;
  for (const auto i : chosen) typical.push_back(std::move(runs[i]));
  return typical;
}

std::string runs_in_words(const Domain& domain, MdpIndex world, const std::vector<PolicyRun>& runs) {
  const auto all = counted(runs.size(), "run");
  std::vector<std::string> told;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (!domain.mdp(world).has_feature(k)) continue;
    const auto n = static_cast<std::size_t>(
        std::count_if(runs.begin(), runs.end(), [&](const PolicyRun& run) { return run.times[k] > 0; }));
    if (n == 0 || n == runs.size()) continue;
    told.push_back(domain.wording(k).one + " in " + std::to_string(n) + (told.empty() ? " of " + all : ""));
  }
  std::string text = listed(told);
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  const auto unfinished = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PolicyRun& run) { return !run.has_ended; }));
  if (unfinished > 0) {
    add((unfinished == runs.size() ? "none of " + all : std::to_string(unfinished) + " of " + all + " not") +
        " finished within " + counted(domain.max_steps(), "step"));
  }
  const auto ways = different_ways(runs);
  if (ways.front().times > 1) {
    add("the same path in " + (ways.size() == 1 ? "all " : std::to_string(ways.front().times) + " of ") + all);
  } else if (runs.size() > 1) {
    add("a different path in each of " + all);
  }
  return text;
}

std::vector<Way> different_ways(const std::vector<PolicyRun>& runs) {
  std::vector<Way> ways;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto known = std::find_if(ways.begin(), ways.end(), [&](const Way& way) {
      return runs[way.run].path.actions == runs[i].path.actions && runs[way.run].path.states == runs[i].path.states;
    });
    if (known == ways.end()) {
      ways.push_back({i, 1});
    } else {
      ++known->times;
    }
  }
  std::stable_sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.times > b.times; });
  return ways;
}

}  // namespace kith
