#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kith/service/authorisation.hpp"
#include "kith/store/event_file.hpp"

namespace kith {

// Whom a token stands for.
struct Identity {
  Role role = Role::kNobody;
  std::int64_t room = 0;
  std::int64_t seat = 0;
  std::string hash{};  // of the token
};

// The links that were given out. Not synchronised.
class Tokens {
 public:
  // A new token and its row, which is to be stored and then added.
  struct Issued {
    std::string token;
    StoredToken row;
  };
  [[nodiscard]] static Issued issue(Role role, std::int64_t room, std::int64_t seat, std::int64_t expires_us);
  void add(const StoredToken& row);
  void add(const Issued& issued);
  // Nobody unless the token is known, not expired and not revoked. Takes the same time whatever is wrong with it.
  [[nodiscard]] Identity identify(std::string_view token, std::int64_t now_us) const;
  void revoke(const std::string& hash);
  // Hashes of the valid tokens of a seat.
  [[nodiscard]] std::vector<std::string> of_seat(std::int64_t room, std::int64_t seat) const;
  // The secret of the latest valid token of a seat, if it was issued by this process.
  [[nodiscard]] std::optional<std::string> known(std::int64_t room, std::int64_t seat) const;

 private:
  std::map<std::string, StoredToken> rows_;     // by hash
  std::map<std::string, std::string> secrets_;  // by hash: of those issued by this process, for the facilitator
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::string>> seats_;  // hashes by room and seat
};

}  // namespace kith
