#include "strands.hpp"

#include <utility>

namespace kith {

Strands::Strands(const std::shared_ptr<const Atlas>& atlas, std::size_t threads, std::size_t cache_bytes,
                 BusyCount& busy)
    : busy_{busy} {
  const auto store = std::make_shared<PartitionStore>(*atlas);
  for (std::size_t i = 0; i < threads; ++i)
    threads_.emplace_back([this, atlas, cache_bytes, store] { run(atlas, cache_bytes, store); });
}

Strands::~Strands() {
  {
    const std::lock_guard lock{mutex_};
    stopping_ = true;
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void Strands::post(std::size_t key, Job job) {
  busy_.begin();
  {
    const std::lock_guard lock{mutex_};
    auto& queue = queues_[key];
    queue.jobs.push_back(std::move(job));
    if (queue.jobs.size() > 1 || queue.is_running) return;
    ready_.push_back(key);
  }
  changed_.notify_one();
}

void Strands::run(std::shared_ptr<const Atlas> atlas, std::size_t cache_bytes, std::shared_ptr<PartitionStore> store) {
  TeachingCache cache{std::move(atlas), cache_bytes, std::move(store)};
  std::unique_lock lock{mutex_};
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || !ready_.empty(); });
    if (ready_.empty()) return;

    const auto key = ready_.front();
    ready_.pop_front();
    auto& queue = queues_[key];
    auto job = std::move(queue.jobs.front());
    queue.jobs.pop_front();
    queue.is_running = true;

    lock.unlock();
    job(cache);
    job = nullptr;
    lock.lock();

    auto& after = queues_[key];
    after.is_running = false;
    if (after.jobs.empty()) {
      queues_.erase(key);
    } else {
      ready_.push_back(key);
      changed_.notify_one();
    }

    // A strand stands in the list at most once, so its jobs run one after the other.
    lock.unlock();
    busy_.end();
    lock.lock();
  }
}

}  // namespace kith
