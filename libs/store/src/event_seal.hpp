#pragma once

#include <string>
#include <string_view>

#include "kith/store/event_file.hpp"

// The checksums of rows: bound to the file (its key), the kind of row and everything in it.
namespace kith {

// 32 bytes that tell the file of that id and study.
[[nodiscard]] std::string store_key(std::string_view id, std::string_view study);

// 16 bytes each.
[[nodiscard]] std::string seal(const StoredEvent& event, std::string_view key);
[[nodiscard]] std::string seal(const StoredRoom& room, std::string_view key);
[[nodiscard]] std::string seal(const StoredToken& token, std::string_view key);

}  // namespace kith
