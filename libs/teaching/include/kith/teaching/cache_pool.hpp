#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "kith/teaching/cache.hpp"

namespace kith {

/// Threads take an atlas's cache each, and give it back. The atlas outlives it.
class CachePool {
 public:
  explicit CachePool(const Atlas& atlas) : atlas_{atlas} {}
  [[nodiscard]] std::unique_ptr<TeachingCache> take() {
    const std::lock_guard lock{mutex_};
    if (free_.empty()) return std::make_unique<TeachingCache>(atlas_);
    auto cache = std::move(free_.back());
    free_.pop_back();
    return cache;
  }
  void give_back(std::unique_ptr<TeachingCache> cache) {
    cache->trim();
    const std::lock_guard lock{mutex_};
    free_.push_back(std::move(cache));
  }

 private:
  const Atlas& atlas_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TeachingCache>> free_;
};

}  // namespace kith
