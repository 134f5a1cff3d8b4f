#include "kith/study/study.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "kith/study/team_run.hpp"

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
  // One cache per thread; it changes the speed, never a result.
  tbb::enumerable_thread_specific<TeachingCache> caches{[&] { return TeachingCache{atlas.constraints()}; }};
  const auto threads = options.threads == 0 ? tbb::task_arena::automatic : static_cast<int>(options.threads);
  const tbb::global_control limit{
      tbb::global_control::max_allowed_parallelism,
      options.threads == 0 ? static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) : options.threads};
  tbb::task_arena arena{threads};
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>{0, addresses.size(), 1}, [&](const tbb::blocked_range<std::size_t>& range) {
          for (auto i = range.begin(); i != range.end(); ++i) {
            if (stopped) return;
            slots[i] = run_team(atlas, caches.local(), study.variants[addresses[i].variant], addresses[i]);
            report();
          }
        });
  });

  RunResult result;
  result.stopped = stopped;
  for (auto& slot : slots) {
    if (slot) result.teams.push_back(std::move(*slot));
  }
  return result;
}

}  // namespace kith
