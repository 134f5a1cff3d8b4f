#include "kith/files/table_text.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/core/memory.hpp"

namespace kith {
namespace {

Error too_large(const std::string& file, const std::string& size, std::uint64_t most, const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.id = "E0513";
  diagnostic.file = file;
  diagnostic.message = "the table has " + size + "; at most " + memory_text(most) + " are read";
  diagnostic.hint = hint;
  return Error{{diagnostic}};
}

}  // namespace

std::string read_table_text(std::istream& stream, const std::string& name) {
  constexpr std::size_t kPieceSize = std::size_t{1} << 20U;
  std::vector<char> piece(kPieceSize);
  std::string text;
  MemoryGuard guard{"reading " + name, "keep only the rows and columns that are needed"};
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    guard.take(2 * count);  // while a text grows there are two
    text.append(piece.data(), count);
    if (text.size() > kMaxStreamBytes)
      throw too_large(name, "no end after " + memory_text(text.size()), kMaxStreamBytes,
                      "save it to a file, of which more is read");
    if (std::memchr(piece.data(), 0, count) != nullptr) return text;
  }
  if (stream.bad()) throw Error{ErrorKind::kIo, "cannot read " + name};
  return text;
}

std::string read_table_text(const std::filesystem::path& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure))
    throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": " + std::generic_category().message(EISDIR)};
  errno = 0;
  std::ifstream stream{path, std::ios::binary};
  if (!stream)
    throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": " + std::generic_category().message(errno)};
  if (!std::filesystem::is_regular_file(path, failure)) return read_table_text(stream, path.string());

  const auto size = std::filesystem::file_size(path, failure);
  if (failure) throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": " + failure.message()};
  if (size > kMaxTableBytes)
    throw too_large(path.string(), memory_text(size), kMaxTableBytes, "keep only the rows and columns that are needed");
  require_memory(size, "reading " + path.string(), "keep only the rows and columns that are needed");
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw Error{ErrorKind::kIo, "cannot read " + path.string()};
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace kith
