#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace kith {

// An archive of files by name (POSIX ustar), which every system unpacks. Names of at most 100 bytes.
[[nodiscard]] std::string tar_of(const std::map<std::string, std::string>& files, std::int64_t seconds_since_1970);

}  // namespace kith
