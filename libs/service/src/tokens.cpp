#include "tokens.hpp"

#include <utility>

#include "kith/files/sha256.hpp"
#include "kith/store/random_token.hpp"

namespace kith {
namespace {

std::string hash_of(std::string_view token) {
  Sha256 hash;
  hash.update(token);
  return std::move(hash).digest();
}

}  // namespace

void Tokens::add(const StoredToken& row) {
  rows_[row.hash] = row;
  if (row.role == name_of(Role::kParticipant)) seats_[{row.room, row.seat}].push_back(row.hash);
}

Tokens::Issued Tokens::issue(Role role, std::int64_t room, std::int64_t seat, std::int64_t expires_us) {
  Issued issued{.token = random_token(), .row = {}};
  issued.row = {.hash = hash_of(issued.token),
                .role = std::string{name_of(role)},
                .room = room,
                .seat = seat,
                .expires_us = expires_us,
                .revoked = false};
  return issued;
}

void Tokens::add(const Issued& issued) {
  add(issued.row);
  if (issued.row.role == name_of(Role::kParticipant)) secrets_[issued.row.hash] = issued.token;
}

Identity Tokens::identify(std::string_view token, std::int64_t now_us) const {
  const auto hash = hash_of(token);
  // The tree is searched by hashes, which nobody can choose; the comparison that decides takes constant time.
  const auto found = rows_.lower_bound(hash);
  const StoredToken none{.hash = std::string(hash.size(), '\0')};
  const auto& row = found == rows_.end() ? none : found->second;
  const bool is_equal = equal_in_constant_time(row.hash, hash);
  if (!is_equal || row.revoked || now_us >= row.expires_us) return {};
  return {.role = role_named(row.role), .room = row.room, .seat = row.seat, .hash = hash};
}

void Tokens::revoke(const std::string& hash) {
  const auto found = rows_.find(hash);
  if (found != rows_.end()) found->second.revoked = true;
  secrets_.erase(hash);
}

std::vector<std::string> Tokens::of_seat(std::int64_t room, std::int64_t seat) const {
  std::vector<std::string> hashes;
  const auto found = seats_.find({room, seat});
  if (found == seats_.end()) return hashes;
  for (const auto& hash : found->second) {
    if (!rows_.at(hash).revoked) hashes.push_back(hash);
  }
  return hashes;
}

std::optional<std::string> Tokens::known(std::int64_t room, std::int64_t seat) const {
  std::optional<std::string> latest;
  for (const auto& hash : of_seat(room, seat)) {
    const auto found = secrets_.find(hash);
    if (found != secrets_.end()) latest = found->second;
  }
  return latest;
}

}  // namespace kith
