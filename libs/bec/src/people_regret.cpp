#include "people_regret.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kith/core/stream.hpp"

namespace kith {
namespace {

// Some of n, the same in every run, ascending.
std::vector<std::size_t> some_of(std::size_t n, std::size_t most, const RandomStream& random) {
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (n <= most) return all;
  std::sort(all.begin(), all.end(),
            [&](auto a, auto b) { return random.split(a).address() < random.split(b).address(); });
  all.resize(most);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

PeopleRegret::PeopleRegret(std::shared_ptr<PartitionStore> store, const Sample& sample)
    : atlas_{&store->atlas()},
      behaviours_{*atlas_, Behaviours::kDefaultCells, Behaviours::kDefaultRowBytes,
                  std::make_shared<PolicyPartitions>(std::move(store))} {
  const Domain& domain = atlas_->domain();
  const auto random = RandomStream{0}.split("regret of people");
  const double scale = 1.0 / static_cast<double>(domain.count_scale());
  for (const std::size_t m : some_of(domain.num_mdps(), sample.mdps, random.split("mdps"))) {
    const MdpIndex mdp{m};
    const auto& starts = domain.starts(mdp);
    for (const std::size_t i : some_of(starts.size(), sample.starts_per_mdp, random.split("starts").split(m))) {
      Start start{atlas_->index({mdp, starts[i]})};
      for (std::size_t choice = 0; choice < domain.mdp(mdp).choices(starts[i]).size(); ++choice) {
        const auto loss = atlas_->feature_counts(start.index) - atlas_->deviation_counts(start.index, choice);
        start.worst = std::max(start.worst, domain.weights().return_of(loss) * scale);
      }
      starts_.push_back(start);
    }
  }
}

double PeopleRegret::of(const Direction& weights) {
  const Domain& domain = atlas_->domain();
  const double scale = 1.0 / static_cast<double>(domain.count_scale());
  const auto cell = behaviours_.locate(weights);
  double sum = 0.0;
  for (const Start& start : starts_) {
    const auto answer = behaviours_.answer(start.index, cell);
    sum += answer ? std::max(0.0, domain.weights().return_of(atlas_->feature_counts(start.index) - *answer) * scale)
                  : start.worst;
  }
  return starts_.empty() ? 0.0 : sum / static_cast<double>(starts_.size());
}

std::vector<PeopleRegret::Mistake> PeopleRegret::mistakes(const Direction& weights) {
  const Domain& domain = atlas_->domain();
  const double scale = 1.0 / static_cast<double>(domain.count_scale());
  const auto cell = behaviours_.locate(weights);
  std::vector<Mistake> found;
  for (const Start& start : starts_) {
    const auto answer = behaviours_.answer(start.index, cell);
    if (!answer) continue;
    const auto advantage = atlas_->feature_counts(start.index) - *answer;
    const double regret = domain.weights().return_of(advantage) * scale / static_cast<double>(starts_.size());
    if (regret > 0.0) found.push_back({start.index, regret, advantage});
  }
  return found;
}

}  // namespace kith
