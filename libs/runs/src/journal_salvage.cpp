#include "journal_salvage.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "journal_file.hpp"
#include "kith/core/error.hpp"
#include "kith/files/sqlite.hpp"
#include "kith/runs/team_codec.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// The layout of SQLite's files (https://www.sqlite.org/fileformat2.html), as far as it is needed here.
constexpr std::size_t kPage = kJournalPageSize;
constexpr std::size_t kLogHeader = 32;    // of the write-ahead log
constexpr std::size_t kFrameHeader = 24;  // before each page in it
constexpr std::size_t kNextPage = 4;      // at the beginning of an overflow page: the number of the next one
constexpr std::uint64_t kLongestRecord = std::uint64_t{1} << 30;

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

// A row of `units` as it stands in a page: its team, the size of its record and what of it is in the page.
struct Cell {
  std::uint64_t team = 0;
  std::size_t record = 0;
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

std::optional<Cell> cell_at(std::string_view text, std::size_t teams) {
  const auto size = take_number(text);
  if (!size || *size < 4 || *size > kLongestRecord) return std::nullopt;
  const auto team = take_number(text);
  if (!team || *team < 1 || *team > teams) return std::nullopt;
  const auto in_page = size_in_page(static_cast<std::size_t>(*size));
  if (in_page > text.size()) return std::nullopt;
  Cell cell{.team = *team, .here = text.substr(0, in_page)};
  if (in_page < *size) {
    const auto rest = text.substr(in_page);
    if (rest.size() < kNextPage) return std::nullopt;
    cell.overflow = big_endian(rest);
  }
  // The row's own header: its length, nothing for the team, which is the key of the row, and the type of the record.
  auto header = cell.here;
  const auto header_size = take_number(header);
  const auto type_of_team = take_number(header);
  const auto type = take_number(header);
  if (!header_size || !type_of_team || *type_of_team != 0 || !type || *type < 12 || *type % 2 != 0) return std::nullopt;
  if (*header_size != cell.here.size() - header.size() || *size != *header_size + (*type - 12) / 2) return std::nullopt;
  cell.record = static_cast<std::size_t>((*type - 12) / 2);
  cell.here = header;
  return cell;
}

// The pages of the journal, those of the log in front of those of the file.
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

void salvage_records(const fs::path& path, std::string_view key, std::size_t teams,
                     const std::function<void(std::size_t team, std::string_view bytes)>& visit) {
  const Pages pages{path};
  pages.for_each([&](const std::string& page) {
    for (std::size_t at = 0; at < page.size(); ++at) {
      const auto cell = cell_at(std::string_view{page}.substr(at), teams);
      if (!cell) continue;
      const auto team = static_cast<std::size_t>(cell->team);
      for (const bool with_log : {true, false}) {
        const auto bytes = pages.follow(std::string{cell->here}, cell->overflow, cell->record, with_log);
        if (bytes.size() != cell->record || !is_intact(team, bytes, key)) continue;
        visit(team, bytes);
        break;
      }
    }
  });
}

}  // namespace kith
