#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace kith {

/// Who may connect: counts sockets, and per address those that have not shown yet that they are clients of ours.
/// Thread-safe.
class Admission {
 public:
  enum class Verdict { kWelcome, kTooMany, kTooManyOfAddress };

  /// A socket's place, given back when it is destroyed.
  class Place {
   public:
    Place() = default;
    Place(Place&& other) noexcept;
    Place& operator=(Place&& other) noexcept;
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place();
    /// The socket no longer counts against its address.
    void trust();

   private:
    friend class Admission;
    Admission* from_ = nullptr;
    std::string address_{};  // empty where it does not count against one
  };

  Admission(std::size_t max_sockets, std::size_t max_per_address)
      : max_sockets_{max_sockets}, max_per_address_{max_per_address} {}

  /// @param place  filled if the verdict is kWelcome.
  [[nodiscard]] Verdict enter(const std::string& address, bool counts_per_address, Place& place);
  /// Whether so many sockets are open that connections should not be kept for a next request.
  [[nodiscard]] bool is_crowded() const;
  [[nodiscard]] std::size_t num_sockets() const;
  [[nodiscard]] std::uint64_t num_turned_away() const;

 private:
  void leave(const std::string& address);
  void forget(const std::string& address);

  std::size_t max_sockets_;
  std::size_t max_per_address_;
  mutable std::mutex mutex_;
  std::size_t sockets_ = 0;
  std::uint64_t turned_away_ = 0;
  std::unordered_map<std::string, std::size_t> unknown_;
};

/// What limits count as one address: of IPv6 the network of 64 bits, which one household or machine has.
[[nodiscard]] std::string address_group(std::string_view text);

}  // namespace kith
