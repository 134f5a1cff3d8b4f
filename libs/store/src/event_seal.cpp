#include "event_seal.hpp"

#include <utility>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

constexpr std::size_t kSealBytes = 16;

void put(ByteWriter& row, bool value) { row.flag(value); }
void put(ByteWriter& row, std::int64_t value) { row.integer(value); }
void put(ByteWriter& row, std::uint64_t value) { row.count(value); }
void put(ByteWriter& row, const std::string& value) { row.text(value); }

template <typename... Values>
std::string sealed(std::string_view key, char kind, const Values&... values) {
  ByteWriter row;
  row.letter(kind);
  (put(row, values), ...);
  Sha256 hash;
  hash.update(key);
  hash.update(row.bytes());
  return std::move(hash).digest().substr(0, kSealBytes);
}

}  // namespace

std::string store_key(std::string_view id, std::string_view study) {
  ByteWriter writer;
  writer.text("kith.event/1");
  writer.text(id);
  writer.text(study);
  Sha256 hash;
  hash.update(writer.bytes());
  return std::move(hash).digest();
}

std::string seal(const StoredEvent& event, std::string_view key) {
  return sealed(key, 'e', event.room, event.seq, event.at_us, event.actor, event.type, event.json,
                event.message.has_value(), event.message.value_or(""));
}

std::string seal(const StoredRoom& room, std::string_view key) {
  return sealed(key, 'r', room.number, room.setup, room.created_us);
}

std::string seal(const StoredToken& token, std::string_view key) {
  return sealed(key, 't', token.hash, token.role, token.room, token.seat, token.expires_us, token.revoked);
}

}  // namespace kith
