#include "threads.hpp"

#include <system_error>

namespace kith {

std::vector<std::jthread> start_threads(std::size_t wanted, const std::function<void()>& body) {
  std::vector<std::jthread> threads;
  threads.reserve(wanted);
  try {
    while (threads.size() < wanted) threads.emplace_back(body);
  } catch (const std::system_error&) {  // a limit on processes or memory: those that there are do the work
  }
  return threads;
}

}  // namespace kith
