// The engine of lesson pages, made for this machine.
#include "scratch_folder.hpp"

namespace {

std::string lesson_folder() {
  static const kith::testing::ScratchFolder folder;
  return folder.path().string();
}

}  // namespace

#define KITH_LESSON_FOLDER lesson_folder()
#include "../../apps/lesson/src/engine.cpp"
