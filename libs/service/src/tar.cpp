#include "tar.hpp"

#include <stdexcept>

namespace kith {
namespace {

constexpr std::size_t kBlock = 512;

std::string octal(std::uint64_t value, std::size_t digits) {
  std::string text(digits, '0');
  for (std::size_t i = digits; i > 0 && value > 0; --i, value /= 8) text[i - 1] = static_cast<char>('0' + value % 8);
  return text;
}

std::string header_of(const std::string& name, std::size_t size, std::int64_t time) {
  if (name.size() > 100) throw std::invalid_argument{"tar_of: the name of a file is too long"};
  std::string header(kBlock, '\0');
  const auto put = [&](std::size_t at, const std::string& text) { header.replace(at, text.size(), text); };
  put(0, name);
  put(100, "0000644");
  put(108, "0000000");
  put(116, "0000000");
  put(124, octal(size, 11));
  put(136, octal(static_cast<std::uint64_t>(time), 11));
  put(148, "        ");
  put(156, "0");
  put(257, "ustar");
  put(263, "00");
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  put(148, octal(sum, 6) + '\0' + ' ');
  return header;
}

}  // namespace

std::string tar_of(const std::map<std::string, std::string>& files, std::int64_t seconds_since_1970) {
  std::string archive;
  for (const auto& [name, content] : files) {
    archive += header_of(name, content.size(), seconds_since_1970) + content;
    archive.append((kBlock - content.size() % kBlock) % kBlock, '\0');
  }
  archive.append(2 * kBlock, '\0');
  return archive;
}

}  // namespace kith
