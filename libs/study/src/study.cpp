#include "kith/study/study.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "kith/core/parallel_loop.hpp"
#include "kith/study/session_forecasts.hpp"
#include "kith/study/study_memory.hpp"
#include "kith/study/team_run.hpp"

namespace kith {

namespace {

std::size_t num_teams(const StudySpec& spec) {
  return spec.strategies.size() * spec.compositions.size() * spec.replicates;
}

// Calls body(cache, i) for every i that the counter gives, on several threads.
void share_work(const Atlas& atlas, std::size_t n, const StreamOptions& options,
                const std::function<void(TeachingCache& cache, std::size_t i)>& body) {
  class Alone : public WorkCounter {
   public:
    std::uint64_t take(std::uint64_t k) override { return next_.fetch_add(k); }

   private:
    std::atomic<std::uint64_t> next_{0};
  };
  Alone alone;
  auto& counter = options.counter == nullptr ? alone : *options.counter;
  const auto num_workers = options.threads == 0 ? default_num_workers() : options.threads;
  const auto store = std::make_shared<PartitionStore>(atlas);
  const auto cache_bytes = TeachingCache::bytes_of_thread(atlas, num_workers);
  std::atomic<bool> failed{false};
  parallel_loop(num_workers, num_workers, [&](std::size_t, std::size_t) {
    std::optional<TeachingCache> cache;  // it changes the speed, never a result
    while (!failed && !(options.stopped && options.stopped())) {
      const auto begin = counter.take(options.chunk);
      if (begin >= n) return;
      const auto end = std::min<std::uint64_t>(n, begin + options.chunk);
      if (!cache) cache.emplace(atlas, cache_bytes, store);
      try {
        for (auto i = begin; i < end && !failed; ++i) body(*cache, static_cast<std::size_t>(i));
      } catch (...) {
        failed = true;
        throw;
      }
    }
  });
}

}  // namespace

std::size_t num_teams(const Study& study) {
  std::size_t sum = 0;
  for (const auto& variant : study.variants) sum += num_teams(variant);
  return sum;
}

TeamAddress team_address(const Study& study, std::size_t team) {
  std::size_t i = team - 1;
  for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
    const auto& spec = study.variants[variant];
    const auto size = num_teams(spec);
    if (i >= size) {
      i -= size;
      continue;
    }
    const auto cell = i / spec.replicates;
    return {variant, spec.strategies[cell / spec.compositions.size()].name,
            spec.compositions[cell % spec.compositions.size()], i % spec.replicates + 1, team};
  }
  throw std::invalid_argument{"team_address: the study has no team " + std::to_string(team)};
}

std::vector<TeamAddress> team_addresses(const Study& study) {
  std::vector<TeamAddress> addresses;
  const auto n = num_teams(study);
  addresses.reserve(n);
  for (std::size_t team = 1; team <= n; ++team) addresses.push_back(team_address(study, team));
  return addresses;
}

std::string describe_team(const Study& study, const TeamAddress& address) {
  std::string text = "team " + std::to_string(address.team) + " (" + address.strategy + ", " + address.composition;
  for (const auto& factor : study.variants.at(address.variant).factors) text += ", " + factor.key + "=" + factor.value;
  return text + ", replicate " + std::to_string(address.replicate) + ")";
}

RunResult run_teams(const Atlas& atlas, const Study& study, std::span<const TeamAddress> addresses,
                    const RunOptions& options) {
  require_study_memory(study, options.threads, addresses.size());
  std::vector<std::optional<TeamRecord>> slots(addresses.size());
  std::size_t done = 0;
  std::atomic<bool> stopped{false};
  std::mutex progress;
  SessionForecasts forecasts;
  StreamOptions stream;
  stream.threads = options.threads;
  stream.stopped = [&] { return stopped.load(); };
  share_work(atlas, addresses.size(), stream, [&](TeachingCache& cache, std::size_t i) {
    slots[i] = run_team_unless({}, atlas, cache, study.variants[addresses[i].variant], addresses[i], &forecasts);
    if (!options.on_progress) return;
    const std::lock_guard lock{progress};
    if (!options.on_progress(++done, addresses.size())) stopped = true;
  });

  RunResult result;
  result.stopped = stopped;
  for (auto& slot : slots) {
    if (slot) result.teams.push_back(std::move(*slot));
  }
  return result;
}

void stream_teams(const Atlas& atlas, const Study& study, std::span<const std::uint32_t> teams,
                  const StreamOptions& options, const std::function<void(TeamOutcome outcome)>& sink) {
  require_study_memory(study, options.threads);
  SessionForecasts forecasts;
  share_work(atlas, teams.size(), options, [&](TeachingCache& cache, std::size_t i) {
    TeamOutcome outcome{i, team_address(study, teams[i]), {}, {}};
    try {
      outcome.record = run_team_unless(options.stopped, atlas, cache, study.variants[outcome.address.variant],
                                       outcome.address, &forecasts);
      if (!outcome.record) return;
    } catch (...) {
      outcome.failure = std::current_exception();
    }
    sink(std::move(outcome));
  });
}

}  // namespace kith
