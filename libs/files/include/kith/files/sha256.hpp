#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace kith {

/// SHA-256 of the bytes (FIPS 180-4), as 64 hexadecimal digits: tells whether two
/// files are the same.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// The same of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(const Sha256&) = delete;
  Sha256& operator=(Sha256&&) noexcept;
  void update(std::string_view bytes);
  /// The 32 bytes of the hash; nothing can be added any more.
  [[nodiscard]] std::string digest() &&;
  /// As 64 hexadecimal digits.
  [[nodiscard]] std::string hex() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kith
