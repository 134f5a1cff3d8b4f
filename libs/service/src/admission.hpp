#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

#include "connections.hpp"

namespace kith {

/// Who may connect. Counts sockets in all, and per address those that have not shown a valid token: guests. If there is
/// no room for another socket, a guest has to give way: whoever has gone for longest without a complete request, of the
/// same address, or, if the server is full, of the address with the most guests. So idle connections give way to active
/// ones. Thread-safe.
class Admission {
  struct Guest;

 public:
  /// A socket's place, given back when it is destroyed.
  class Place {
   public:
    Place() = default;
    Place(Place&& other) noexcept;
    Place& operator=(Place&& other) noexcept;
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place();
    /// Which connection has the place, and is cut if it has to give way.
    void belongs_to(std::weak_ptr<ServerConnection> connection);
    /// The socket has brought a complete request.
    void renew();
    /// The socket has shown a valid token: it never has to give way.
    void trust();

   private:
    friend class Admission;
    Admission* from_ = nullptr;
    std::shared_ptr<Guest> guest_{};
  };

  Admission(std::size_t max_sockets, std::size_t max_per_address)
      : max_sockets_{max_sockets}, max_per_address_{max_per_address} {}

  struct Verdict {
    bool is_welcome = false;
    std::shared_ptr<ServerConnection> gives_way{};  ///< To be cut; null: nobody.
  };
  /// @param place  filled if the socket is welcome.
  [[nodiscard]] Verdict enter(const std::string& address, bool counts_per_address, Place& place);
  /// Whether so many sockets are open that connections should not be kept for a next request.
  [[nodiscard]] bool is_crowded() const;
  [[nodiscard]] std::size_t num_sockets() const;
  /// Sockets that were not welcome or had to give way.
  [[nodiscard]] std::uint64_t num_turned_away() const;

 private:
  // In the order of their last complete request.
  using Guests = std::list<std::shared_ptr<Guest>>;
  struct Guest {
    enum class Status { kGuest, kTrusted, kGone };
    Status status = Status::kGuest;
    std::string address;
    Guests::iterator at;
    std::weak_ptr<ServerConnection> connection{};
  };

  [[nodiscard]] Guests* crowd_for(const std::string& address, bool counts_per_address);
  void forget(Guest& guest);

  std::size_t max_sockets_;
  std::size_t max_per_address_;
  mutable std::mutex mutex_;
  std::size_t sockets_ = 0;
  std::uint64_t turned_away_ = 0;
  std::unordered_map<std::string, Guests> guests_;  // by address; "": those that count against none
};

/// What limits count as one address: of IPv6 the network of 64 bits, which one household or machine has.
[[nodiscard]] std::string address_group(std::string_view text);

}  // namespace kith
