#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/cache.hpp"

namespace kith::python {

/// A domain with its text, its atlas once somebody asks for it, and the caches of sessions over it, which threads
/// borrow for a call.
class LoadedDomain : public std::enable_shared_from_this<LoadedDomain> {
 public:
  LoadedDomain(Domain domain, std::string text, std::vector<DomainFile> files)
      : domain_{std::move(domain)}, text_{std::move(text)}, files_{std::move(files)} {}

  [[nodiscard]] const Domain& domain() const noexcept { return domain_; }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] const std::vector<DomainFile>& files() const noexcept { return files_; }
  /// Planned when it is first asked for. @pre the interpreter's lock is held; it is released meanwhile.
  [[nodiscard]] std::shared_ptr<const Atlas> atlas();

  /// A cache for one call.
  class Loan {
   public:
    explicit Loan(std::shared_ptr<LoadedDomain> domain);
    ~Loan();
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    [[nodiscard]] TeachingCache& operator*() const noexcept { return *cache_; }
    [[nodiscard]] TeachingCache* operator->() const noexcept { return cache_.get(); }

   private:
    std::shared_ptr<LoadedDomain> domain_;
    std::unique_ptr<TeachingCache> cache_;
  };
  /// @pre as for atlas().
  [[nodiscard]] Loan borrow() {
    (void)atlas();
    return Loan{shared_from_this()};
  }

  /// The start, which must exist and be a candidate.
  [[nodiscard]] StartIndex candidate_of(const py::handle& start);
  /// Any non-terminal state of a world, as a demonstration of its own.
  [[nodiscard]] StartIndex state_of(const py::handle& start);
  /// (world, state)
  [[nodiscard]] static py::tuple start_of(const Atlas& atlas, StartIndex start);

 private:
  Domain domain_;
  std::string text_;
  std::vector<DomainFile> files_;
  std::mutex mutex_;  // never waited for with the interpreter's lock
  std::shared_ptr<const Atlas> atlas_;
  std::vector<std::unique_ptr<TeachingCache>> free_;
};

/// The number of a state where whoever wrote the model counted from 0, as arrays and Gymnasium's tables do; an end that
/// is also passed through has that of the state. On a map, and where a model calls states otherwise, s itself.
[[nodiscard]] std::size_t state_number(const Domain& domain, MdpIndex m, StateIndex s);
/// The state in which the robot acts that has this number; nothing if there is none.
[[nodiscard]] std::optional<StateIndex> state_with_number(const Domain& domain, MdpIndex m, std::size_t number);

using DomainPointer = std::shared_ptr<LoadedDomain>;

}  // namespace kith::python
