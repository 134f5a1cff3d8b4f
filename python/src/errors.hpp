#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "kith/core/error.hpp"

namespace kith::python {

/// The interpreter's lock for threads of the libraries. What Python keeps of such a thread lasts as long as the thread:
/// making it anew for every call takes longer than most calls.
class Lock {
 public:
  Lock();

 private:
  bool is_first_ = PyGILState_GetThisThreadState() == nullptr;
  py::gil_scoped_acquire lock_;
};

/// A Python object that may be copied and dropped by threads that do not hold the interpreter's lock.
class SharedObject {
 public:
  SharedObject() = default;
  /// @pre the lock is held.
  explicit SharedObject(py::object object);
  /// @pre the lock is held.
  [[nodiscard]] py::object get() const { return object_ ? *object_ : py::object{}; }
  [[nodiscard]] explicit operator bool() const noexcept { return object_ != nullptr; }

 private:
  std::shared_ptr<py::object> object_;
};

/// What code written in Python raised while the libraries called it. Its text is the traceback; where nothing in
/// between makes another error of it, the exception itself goes on.
class OwnCodeFailed : public Error {
 public:
  /// @pre the lock is held. @param what  whose code, such as "the strategy 'mine'".
  OwnCodeFailed(const std::string& what, const py::error_already_set& raised);
  /// @pre the lock is held.
  void restore() const;

 private:
  OwnCodeFailed(const std::string& text, SharedObject object)
      : Error{ErrorKind::kPartial, text}, raised_{std::move(object)} {}
  SharedObject raised_;
};

/// What `body`, which calls code written in Python, gives. @pre the lock is held. @param what  whose code, as above.
/// @throws OwnCodeFailed if the code raises; Error (kPartial) if it gives something of another type.
template <typename Body>
std::invoke_result_t<Body> calling_own_code(const std::string& what, Body body) {
  try {
    return body();
  } catch (const py::error_already_set& raised) {
    throw OwnCodeFailed{what, raised};
  } catch (const py::builtin_exception& error) {
    throw Error{ErrorKind::kPartial, what + " gave something of no use: " + error.what()};
  }
}

/// Warnings as Python's: category kith.Warning. @pre the lock is held.
void warn(const std::vector<Diagnostic>& diagnostics);
void warn(const std::string& text);

}  // namespace kith::python
