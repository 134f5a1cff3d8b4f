#include "kith/study/study.hpp"

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "kith/study/team_run.hpp"
#include "parallel_loop.hpp"

namespace kith {

std::vector<TeamAddress> team_addresses(const Study& study) {
  std::vector<TeamAddress> addresses;
  for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
    const auto& spec = study.variants[variant];
    for (const auto strategy : spec.strategies) {
      for (const auto& composition : spec.compositions) {
        for (std::size_t replicate = 1; replicate <= spec.replicates; ++replicate) {
          addresses.push_back({variant, strategy, composition, replicate, addresses.size() + 1});
        }
      }
    }
  }
  return addresses;
}

RunResult run_teams(const Atlas& atlas, const Study& study, std::span<const TeamAddress> addresses,
                    const RunOptions& options) {
  std::vector<std::optional<TeamRecord>> slots(addresses.size());
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  std::mutex progress;
  const auto report = [&] {
    const auto finished = ++done;
    if (!options.on_progress) return;
    const std::lock_guard lock{progress};
    if (!options.on_progress(finished, addresses.size())) stopped = true;
  };
  const auto num_workers = options.threads == 0 ? default_num_workers() : options.threads;
  // One cache per worker; it changes the speed, never a result.
  std::vector<std::optional<TeachingCache>> caches(num_workers);
  parallel_loop(addresses.size(), num_workers, [&](std::size_t worker, std::size_t i) {
    if (stopped) return;
    auto& cache = caches[worker];
    if (!cache) cache.emplace(atlas.constraints());
    slots[i] = run_team(atlas, *cache, study.variants[addresses[i].variant], addresses[i]);
    report();
  });

  RunResult result;
  result.stopped = stopped;
  for (auto& slot : slots) {
    if (slot) result.teams.push_back(std::move(*slot));
  }
  return result;
}

}  // namespace kith
