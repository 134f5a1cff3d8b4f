#include "journal_salvage.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <variant>

#include "journal_file.hpp"
#include "kith/files/sqlite_pages.hpp"
#include "kith/runs/team_codec.hpp"

namespace kith {

static_assert(kJournalPageSize == kSqlitePageSize);

void salvage_records(const std::filesystem::path& path, std::string_view key, std::size_t teams,
                     const std::function<void(std::size_t team, std::string_view bytes)>& visit) {
  constexpr std::array kUnits{SqliteType::kRowNumber, SqliteType::kBlob};
  scan_sqlite_rows(path, kUnits, [&](const SqliteRow& row) {
    if (row.number < 1 || !std::in_range<std::size_t>(row.number)) return false;
    const auto team = static_cast<std::size_t>(row.number);
    if (team > teams) return false;
    const auto& bytes = std::get<std::string>(row.values[1]);
    if (!is_intact(team, bytes, key)) return false;
    visit(team, bytes);
    return true;
  });
}

}  // namespace kith
