#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "kith/store/event_file.hpp"

// The identity of a store, as it stands in the database and in the file beside it.
namespace kith {

struct StoreFacts {
  StoreIdentity identity;
  std::string id;  // 32 hexadecimal digits
  std::int64_t created_us = 0;
};

inline constexpr const char* kStoreSchema = "kith.session/1";

// 128 random bits as 32 hexadecimal digits.
[[nodiscard]] std::string new_store_id();

// As rows of the table meta, with a checksum; and back: nothing if the checksum or the schema is another.
[[nodiscard]] std::map<std::string, std::string> to_meta(const StoreFacts& facts);
[[nodiscard]] std::optional<StoreFacts> from_meta(const std::map<std::string, std::string>& meta);

// The file beside the database. Nothing if there is none, or it is damaged.
void write_identity_file(const std::filesystem::path& folder, const StoreFacts& facts);
[[nodiscard]] std::optional<StoreFacts> read_identity_file(const std::filesystem::path& folder);

}  // namespace kith
