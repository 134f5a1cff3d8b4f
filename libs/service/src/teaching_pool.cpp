#include "teaching_pool.hpp"

#include <utility>

namespace kith {
namespace {

constexpr std::size_t kMostWaiting = 64;  // each keeps a copy of a session

}  // namespace

TeachingPool::TeachingPool(const std::shared_ptr<const Atlas>& atlas, std::size_t threads, std::size_t cache_bytes,
                           BusyCount& busy)
    : busy_{busy} {
  const auto store = std::make_shared<PartitionStore>(*atlas);
  for (std::size_t i = 0; i < threads; ++i)
    threads_.emplace_back([this, atlas, cache_bytes, store] { run(atlas, cache_bytes, store); });
}

void TeachingPool::stop() {
  {
    const std::lock_guard lock{mutex_};
    stopping_ = true;
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
  for (std::size_t i = now_.size() + ahead_.size(); i > 0; --i) busy_.end();
  now_.clear();
  ahead_.clear();
}

void TeachingPool::post(Urgency urgency, Job job) {
  {
    const std::lock_guard lock{mutex_};
    if (stopping_) return;
    auto& queue = urgency == Urgency::kNow ? now_ : ahead_;
    busy_.begin();
    queue.push_back(std::move(job));
    if (urgency == Urgency::kAhead && ahead_.size() > kMostWaiting) {
      ahead_.pop_front();
      busy_.end();
    }
  }
  changed_.notify_one();
}

void TeachingPool::run(std::shared_ptr<const Atlas> atlas, std::size_t cache_bytes,
                       std::shared_ptr<PartitionStore> store) {
  TeachingCache cache{std::move(atlas), cache_bytes, std::move(store)};
  while (true) {
    Job job;
    {
      std::unique_lock lock{mutex_};
      changed_.wait(lock, [&] { return stopping_ || !now_.empty() || !ahead_.empty(); });
      if (stopping_) return;
      auto& queue = now_.empty() ? ahead_ : now_;
      job = std::move(queue.front());
      queue.pop_front();
    }
    job(cache);
    job = nullptr;
    busy_.end();
  }
}

}  // namespace kith
