#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "typescript.hpp"
#include "views.hpp"

namespace kith::testing {
namespace {

// Compares a file of the pages with what is printed, or writes it.
void expect_printed(const std::string& file, const std::string& text) {
  const auto path = std::string{KITH_SOURCE_DIR} + "/web/src/" + file;
  if (std::getenv("KITH_PRINT_PROTOCOL") != nullptr) std::ofstream{path} << text;
  std::ifstream in{path};
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>{in}, {}}), text)
      << "web/src/" << file << " is not what libs/live says of its messages and views. Print it anew:\n"
      << "  KITH_PRINT_PROTOCOL=1 kith_live_tests --gtest_filter='Protocol.*'";
}

constexpr std::string_view kPrinted =
    "// Printed by the tests of libs/live from the members of its events and views: do not edit "
    "(docs/live-protocol.md).\n";

TEST(Protocol, OfParticipantsIsThatOfThePages) {
  TypeScript print;
  print.text = kPrinted;
  print.text += R"(import type { Frame, Path, PlayBoard } from '../shared/board/types';
import type { KeyPress } from '../shared/play/drive';
import type { Bracket } from '../shared/play/brackets';
import type { Runs } from '../shared/play/runs';
import type { Stores } from '../shared/stores';

export type { Frame };

)";
  print.type_of<view::Participant>();
  print.add_commands<RoomSender::kSeat>("Commands");
  print.text += R"(export type Stage = ParticipantView['stage'];
export type CommandType = keyof Commands;

export interface Message<T extends CommandType = CommandType> {
  t: T;
  id: string;
  body: Commands[T];
}
)";
  expect_printed("live/protocol.ts", print.text);
}

TEST(Protocol, OfFacilitatorsHasTheRoomsAndTheirCommands) {
  TypeScript print;
  print.text = kPrinted;
  print.text += "import type { Path, PlayBoard } from '../shared/board/types';\n\n";
  print.type_of<view::RoomRow>();
  print.type_of<view::RoomDetail>();
  print.add_commands<RoomSender::kFacilitator>("RoomCommands");
  expect_printed("facilitator/room.ts", print.text);
}

}  // namespace
}  // namespace kith::testing
