#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>

#include "kith/analysis/study_power.hpp"
#include "kith/core/memory.hpp"
#include "kith/core/parallel_loop.hpp"
#include "kith/study/study_memory.hpp"

namespace kith {

void require_pool_memory(const Study& study, std::size_t threads, std::size_t teams) {
  const std::uint64_t bytes_of_team =
      outcomes().size() * sizeof(double) + sizeof(std::uint32_t);  // and the number of the team
  const auto how_many = threads == 0 ? default_num_workers() : threads;
  require_memory(how_many * memory_per_thread(study) + teams * bytes_of_team,
                 "keeping the outcomes of " + std::to_string(teams) + " teams and teaching on " +
                     std::to_string(how_many) + (how_many == 1 ? " thread" : " threads"),
                 "use fewer teams, particles or threads");
}

std::optional<std::vector<TeamPool>> simulate_pools(const Atlas& atlas, const Study& study, const RunOptions& options) {
  require_pool_memory(study, options.threads, num_teams(study));
  std::vector<TeamPool> pools;
  std::vector<std::size_t> first;  // position of each variant's first team
  std::size_t total = 0;
  for (const auto& spec : study.variants) {
    pools.push_back(TeamPool::empty(spec));
    first.push_back(total);
    total += spec.strategies.size() * spec.compositions.size() * spec.replicates;
  }
  std::vector<std::uint32_t> numbers(total);
  std::iota(numbers.begin(), numbers.end(), std::uint32_t{1});

  std::atomic<bool> stopped{false};
  std::mutex progress;
  std::size_t done = 0;
  StreamOptions stream;
  stream.threads = options.threads;
  stream.stopped = [&] { return stopped.load(); };
  stream_teams(atlas, study, numbers, stream, [&](const TeamOutcome& outcome) {
    if (outcome.failure) std::rethrow_exception(outcome.failure);
    const auto variant = outcome.address.variant;
    pools[variant].set(outcome.position - first[variant], *outcome.record);  // every team has a place of its own
    if (!options.on_progress) return;
    const std::lock_guard lock{progress};
    if (!options.on_progress(++done, total)) stopped = true;
  });
  if (stopped && done < total) return std::nullopt;
  return pools;
}

}  // namespace kith
