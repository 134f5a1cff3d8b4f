#include "kith/files/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

namespace kith {
namespace {

TEST(TemporaryFolder, IsItsOwnersAloneAndGoesWithEverythingInIt) {
  std::optional<TemporaryFolder> one{std::in_place, "kith-folder"};
  const TemporaryFolder other{"kith-folder"};
  const auto path = one->path();
  EXPECT_NE(path, other.path());
  EXPECT_EQ(path.filename().string().rfind("kith-folder-", 0), 0u);
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms::owner_all);
  std::filesystem::create_directories(path / "inside");
  std::ofstream{path / "inside" / "file"} << "text";
  one.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(other.path()));
}

}  // namespace
}  // namespace kith
