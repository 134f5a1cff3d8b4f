#include "errors.hpp"

namespace kith::python {
namespace {

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return "usage";
    case ErrorKind::kInvalidInput:
      return "invalid-input";
    case ErrorKind::kInfeasible:
      return "infeasible";
    case ErrorKind::kIo:
      return "io";
    case ErrorKind::kPartial:
      return "partial";
    case ErrorKind::kMismatch:
      return "mismatch";
    case ErrorKind::kBusy:
      return "busy";
  }
  return "usage";
}

// What helps here; the command line says the same with its options.
const char* remedy_text(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
      return "";
    case Remedy::kReplaceContents:
      return "use another folder, or replace=True";
    case Remedy::kStartOver:
      return "replace=True begins anew";
    case Remedy::kAllowStart:
      return "resume='auto' begins where there is nothing to resume";
    case Remedy::kRunStudy:
      return "run kith.study() first";
    case Remedy::kRunShard:
      return "run the shard first";
    case Remedy::kMergeShards:
    case Remedy::kMergePart:
      return "put the shards together with the program: kith merge DIR... -o DIR";
    case Remedy::kAnalyseTable:
      return "analyse the table on its own: kith analyze FILE.csv --model FORMULA";
    case Remedy::kShowMap:
      return "look at the domain: it draws itself in a notebook, and str(domain) has its map";
    case Remedy::kShowStates:
      return "domain.worlds[m].state_names lists the states";
    case Remedy::kListConstraints:
      return "domain.region.facets lists the constraints";
  }
  return "";
}

py::object error_class() { return py::module_::import("kith._errors").attr("Error"); }

py::object to_python(const Diagnostic& diagnostic) {
  const auto number = [](std::size_t n) -> py::object { return n == 0 ? py::object{py::none()} : py::int_(n); };
  const std::string remedy = remedy_text(diagnostic.remedy);
  const auto help =
      diagnostic.hint.empty() || remedy.empty() ? diagnostic.hint + remedy : diagnostic.hint + "; " + remedy;
  return py::module_::import("kith._errors")
      .attr("Diagnostic")(diagnostic.id, diagnostic.message, diagnostic.file, number(diagnostic.line),
                          number(diagnostic.column), help);
}

void raise(const Error& error) {
  py::list diagnostics;
  for (const auto& diagnostic : error.diagnostics()) {
    if (diagnostic.severity == Severity::kError) diagnostics.append(to_python(diagnostic));
  }
  std::string text = error.what();
  if (const std::string remedy = remedy_text(error.remedy()); !remedy.empty()) text += "\n   = help: " + remedy;
  const py::object object = error_class()(text, name_of(error.kind()), diagnostics);
  PyErr_SetObject(error_class().ptr(), object.ptr());
}

std::string traceback_of(const py::error_already_set& raised) {
  const auto lines =
      py::module_::import("traceback").attr("format_exception")(raised.type(), raised.value(), raised.trace());
  std::string text = py::str("").attr("join")(lines).cast<std::string>();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

Lock::Lock() {
  struct AtEndOfThread {
    ~AtEndOfThread() {
      if (Py_IsInitialized() == 0) return;
      py::gil_scoped_acquire lock;
      lock.dec_ref();
    }
  };
  if (!is_first_) return;
  thread_local AtEndOfThread release;
  lock_.inc_ref();
}

SharedObject::SharedObject(py::object object)
    : object_{new py::object{std::move(object)}, [](py::object* last) {
                if (Py_IsInitialized() == 0) return;  // the interpreter is gone, and its objects with it
                const Lock lock;
                delete last;
              }} {}

OwnCodeFailed::OwnCodeFailed(const std::string& what, const py::error_already_set& raised)
    : OwnCodeFailed{what + " raised an exception\n" + traceback_of(raised), SharedObject{raised.value()}} {}

void OwnCodeFailed::restore() const {
  const auto object = raised_.get();
  PyErr_SetObject(py::type::handle_of(object).ptr(), object.ptr());
}

void warn(const std::string& text) {
  if (PyErr_WarnEx(py::module_::import("kith._errors").attr("Warning").ptr(), text.c_str(), 2) != 0)
    throw py::error_already_set{};
}

void warn(const std::vector<Diagnostic>& diagnostics) {
  for (const auto& diagnostic : diagnostics) {
    if (diagnostic.severity == Severity::kWarning) warn(to_text(diagnostic));
  }
}

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const OwnCodeFailed& error) {
      error.restore();
    } catch (const Error& error) {
      raise(error);
    }
  });
}

}  // namespace kith::python
