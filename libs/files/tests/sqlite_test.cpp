#include "kith/files/sqlite.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "scratch_folder.hpp"

namespace kith {
namespace {

TEST(Database, MakesAllOfATransactionOrNothing) {
  const testing::ScratchFolder scratch;
  Database database{scratch.path() / "one.sqlite", Database::Mode::kMake};
  database.execute("CREATE TABLE number(value INTEGER PRIMARY KEY)");
  const auto count = [&] {
    auto rows = database.prepare("SELECT count(*) FROM number");
    return rows.step() ? rows.integer(0) : -1;
  };
  database.transaction([&] { database.execute("INSERT INTO number VALUES (1), (2)"); });
  EXPECT_EQ(count(), 2);
  EXPECT_THROW(database.transaction([&] {
    database.execute("INSERT INTO number VALUES (3)");
    throw std::runtime_error{"changed our mind"};
  }),
               std::runtime_error);
  EXPECT_EQ(count(), 2);
  EXPECT_THROW(database.transaction([&] { database.execute("INSERT INTO number VALUES (4), (1)"); }), SqliteError);
  EXPECT_EQ(count(), 2);
  database.transaction([&] { database.execute("INSERT INTO number VALUES (5)"); });  // none is open any more
  EXPECT_EQ(count(), 3);
}

}  // namespace
}  // namespace kith
