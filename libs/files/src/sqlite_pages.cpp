#include "kith/files/sqlite_pages.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <unordered_map>

#include "kith/core/error.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// The layout of SQLite's files (https://www.sqlite.org/fileformat2.html), as far as it is needed here.
constexpr std::size_t kPage = kSqlitePageSize;
constexpr std::size_t kLogHeader = 32;    // of the write-ahead log
constexpr std::size_t kFrameHeader = 24;  // before each page in it
constexpr std::size_t kNextPage = 4;      // at the beginning of an overflow page: the number of the next one
constexpr std::uint64_t kLongestRow = std::uint64_t{1} << 30;

class OpenFile {
 public:
  // Nothing is opened if there is no such file. @throws kith::Error
  explicit OpenFile(const fs::path& path) : descriptor_{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)} {
    if (descriptor_ < 0 && errno != ENOENT) {
      throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": " + std::generic_category().message(errno)};
    }
    struct stat status = {};
    if (descriptor_ >= 0 && fstat(descriptor_, &status) == 0 && status.st_size > 0)
      size_ = static_cast<std::size_t>(status.st_size);
  }
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  // A page from `offset` on, filled up with zeros beyond the end and where the disk gives nothing.
  [[nodiscard]] std::string page_at(std::size_t offset) const {
    std::string page(kPage, '\0');
    std::size_t filled = 0;
    while (filled < kPage) {
      const auto n = pread(descriptor_, page.data() + filled, kPage - filled, static_cast<off_t>(offset + filled));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      filled += static_cast<std::size_t>(n);
    }
    return page;
  }

 private:
  int descriptor_;
  std::size_t size_ = 0;
};

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// SQLite's number of one to nine bytes at the beginning of the text, which is cut off.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 9 && i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool last = i == 8;
    value = last ? value << 8 | byte : value << 7 | (byte & 0x7Fu);
    if (last || byte < 0x80) {
      text.remove_prefix(i + 1);
      return value;
    }
  }
  return std::nullopt;
}

constexpr std::uint64_t kZero = 8;  // serial types of the integers 0 and 1, which take no bytes
constexpr std::uint64_t kOne = 9;
constexpr std::uint64_t kFirstBlob = 12;  // and all even types from here; odd ones are texts

// Bytes of an integer of that serial type; nothing if it is no integer.
std::optional<std::size_t> integer_size(std::uint64_t type) {
  constexpr std::size_t kSizes[] = {0, 1, 2, 3, 4, 6, 8};
  if (type == kZero || type == kOne) return 0;
  if (type == 0 || type > 6) return std::nullopt;
  return kSizes[type];
}

// Bytes of a value of that serial type in a column of that kind; nothing if it does not fit.
std::optional<std::size_t> value_size(SqliteType column, std::uint64_t type) {
  const bool is_text = type > kFirstBlob && type % 2 == 1;
  const bool is_blob = type >= kFirstBlob && type % 2 == 0;
  const auto length = type < kFirstBlob ? 0 : static_cast<std::size_t>((type - kFirstBlob) / 2);
  switch (column) {
    case SqliteType::kRowNumber:
      return type == 0 ? std::optional<std::size_t>{0} : std::nullopt;
    case SqliteType::kInteger:
      return integer_size(type);
    case SqliteType::kText:
      return is_text ? std::optional{length} : std::nullopt;
    case SqliteType::kTextOrNull:
      return type == 0 || is_text ? std::optional{length} : std::nullopt;
    case SqliteType::kBlob:
      return is_blob ? std::optional{length} : std::nullopt;
  }
  return std::nullopt;
}

// A row as it stands in a page: its number, its serial types, the size of its values and what of them is in the page.
struct Cell {
  std::uint64_t number = 0;
  std::vector<std::uint64_t> types;
  std::size_t size = 0;
  std::string_view here;
  std::uint32_t overflow = 0;  // the page that the rest begins in; 0 if there is none
};

// How much of a payload of `size` bytes stands in the page itself.
std::size_t size_in_page(std::size_t size) {
  constexpr std::size_t kLargest = kPage - 35;
  constexpr std::size_t kSmallest = (kPage - 12) * 32 / 255 - 23;
  if (size <= kLargest) return size;
  const auto some = kSmallest + (size - kSmallest) % (kPage - kNextPage);
  return some <= kLargest ? some : kSmallest;
}

std::optional<Cell> cell_at(std::string_view text, std::span<const SqliteType> columns) {
  const auto size = take_number(text);
  if (!size || *size <= columns.size() || *size > kLongestRow) return std::nullopt;
  const auto number = take_number(text);
  if (!number) return std::nullopt;
  const auto in_page = size_in_page(static_cast<std::size_t>(*size));
  if (in_page > text.size()) return std::nullopt;
  auto header = text.substr(0, in_page);
  const auto header_size = take_number(header);
  if (!header_size || *header_size <= columns.size() || *header_size > in_page) return std::nullopt;
  Cell cell;
  cell.number = *number;
  for (const auto column : columns) {
    const auto type = take_number(header);
    const auto bytes = type ? value_size(column, *type) : std::nullopt;
    if (!bytes) return std::nullopt;
    cell.types.push_back(*type);
    cell.size += *bytes;
  }
  if (*header_size != in_page - header.size() || *size != *header_size + cell.size) return std::nullopt;
  cell.here = header;
  if (in_page < *size) {
    const auto rest = text.substr(in_page);
    if (rest.size() < kNextPage) return std::nullopt;
    cell.overflow = big_endian(rest);
  }
  return cell;
}

std::int64_t integer_of(std::uint64_t type, std::string_view bytes) {
  if (type == kZero || type == kOne) return type == kOne ? 1 : 0;
  std::uint64_t value = (static_cast<unsigned char>(bytes.front()) & 0x80u) != 0 ? ~std::uint64_t{0} : 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return static_cast<std::int64_t>(value);
}

SqliteRow row_of(const Cell& cell, std::span<const SqliteType> columns, std::string_view bytes) {
  SqliteRow row{.number = static_cast<std::int64_t>(cell.number), .values = {}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto value = bytes.substr(0, value_size(columns[i], cell.types[i]).value_or(0));
    bytes.remove_prefix(value.size());
    if (cell.types[i] == 0) {
      row.values.emplace_back();
    } else if (columns[i] == SqliteType::kInteger) {
      row.values.emplace_back(integer_of(cell.types[i], value));
    } else {
      row.values.emplace_back(std::string{value});
    }
  }
  return row;
}

// The pages of a database, those of the log in front of those of the file.
class Pages {
 public:
  explicit Pages(const fs::path& path) : file_{path}, log_{fs::path{path}.concat("-wal")} {
    for (std::size_t at = kLogHeader; at + kFrameHeader < log_.size(); at += kFrameHeader + kPage) {
      const auto frame = log_.page_at(at);
      latest_[big_endian(frame)] = at + kFrameHeader;
    }
  }

  // Every page there is, also those of the log that a later one replaces.
  void for_each(const std::function<void(const std::string& page)>& visit) const {
    for (std::size_t at = 0; at < file_.size(); at += kPage) visit(file_.page_at(at));
    for (std::size_t at = kLogHeader; at + kFrameHeader < log_.size(); at += kFrameHeader + kPage)
      visit(log_.page_at(at + kFrameHeader));
  }

  // Follows a chain of overflow pages until `size` bytes are there, or nothing comes any more.
  [[nodiscard]] std::string follow(std::string bytes, std::uint32_t number, std::size_t size, bool with_log) const {
    while (bytes.size() < size && number != 0) {
      const auto found = with_log ? latest_.find(number) : latest_.end();
      const auto offset = (std::size_t{number} - 1) * kPage;
      if (found == latest_.end() && offset >= file_.size()) break;
      const auto page = found != latest_.end() ? log_.page_at(found->second) : file_.page_at(offset);
      number = big_endian(page);
      bytes += page.substr(kNextPage, size - bytes.size());
    }
    return bytes;
  }

 private:
  OpenFile file_, log_;
  std::unordered_map<std::uint32_t, std::size_t> latest_;  // by page number, where it is in the log
};

}  // namespace

void scan_sqlite_rows(const fs::path& path, std::span<const SqliteType> columns,
                      const std::function<bool(const SqliteRow& row)>& accept) {
  if (columns.empty()) throw std::invalid_argument{"scan_sqlite_rows: there must be a column"};
  const Pages pages{path};
  pages.for_each([&](const std::string& page) {
    for (std::size_t at = 0; at < page.size(); ++at) {
      const auto cell = cell_at(std::string_view{page}.substr(at), columns);
      if (!cell) continue;
      for (const bool with_log : {true, false}) {
        const auto bytes = pages.follow(std::string{cell->here}, cell->overflow, cell->size, with_log);
        if (bytes.size() == cell->size && accept(row_of(*cell, columns, bytes))) break;
      }
    }
  });
}

}  // namespace kith
