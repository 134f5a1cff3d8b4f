#pragma once

#include <string_view>

namespace kith {

/// A file of a page, embedded in the program.
struct Asset {
  std::string_view path;  ///< "/assets/live/app.js"
  std::string_view type;  ///< Its Content-Type.
  std::string_view etag;  ///< SHA-256 of the body as hexadecimal digits, without quotes.
  std::string_view body;
  std::string_view gzip;  ///< The same compressed; empty where that saves nothing.
};

}  // namespace kith
