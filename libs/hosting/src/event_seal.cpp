#include "event_seal.hpp"

#include <utility>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

constexpr std::size_t kSealBytes = 16;

std::string sealed(const ByteWriter& row, std::string_view key) {
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
  ByteWriter row;
  row.letter('e');
  row.integer(event.room);
  row.count(event.seq);
  row.integer(event.at_us);
  row.text(event.actor);
  row.text(event.type);
  row.text(event.json);
  row.flag(event.message.has_value());
  row.text(event.message.value_or(""));
  return sealed(row, key);
}

std::string seal(const StoredRoom& room, std::string_view key) {
  ByteWriter row;
  row.letter('r');
  row.integer(room.number);
  row.text(room.setup);
  row.integer(room.created_us);
  return sealed(row, key);
}

std::string seal(const StoredToken& token, std::string_view key) {
  ByteWriter row;
  row.letter('t');
  row.text(token.hash);
  row.text(token.role);
  row.integer(token.room);
  row.integer(token.seat);
  row.integer(token.expires_us);
  row.flag(token.revoked);
  return sealed(row, key);
}

}  // namespace kith
