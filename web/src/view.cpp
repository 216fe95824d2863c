// The functions that web/site/worker.js calls: the session of `ahm view`, without a server. The module has one thread.
#include "output/view.hpp"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/io/memory_files.hpp"
#include "output/wording.hpp"
#include "progress.hpp"

// NOLINTBEGIN(readability-identifier-naming)
#define AHM_EXPORT(name) extern "C" [[clang::export_name(#name)]]
extern "C" [[clang::import_module("ahm"), clang::import_name("progress")]] void ahm_progress(const char* stage,
                                                                                             std::size_t bytes,
                                                                                             double fraction);

namespace ahm::web {

void show_progress(std::string_view stage, double fraction) { ahm_progress(stage.data(), stage.size(), fraction); }

namespace {

constexpr const char* out_of_memory =
    "out of memory: a page has at most 4 GB; open a smaller file, or use 'ahm view', which has no such limit";

std::unique_ptr<const app::View> view;
viewer::Answer answer;

viewer::Answer failure(int status, const std::string& text) {
  const nlohmann::json body = {{"error", text}};
  return {status, "application/json", body.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)};
}

/// Opens a file that `ahm_file` stored. The answer contains the warnings.
viewer::Answer open(const std::string& file) {
  app::ViewOptions options;
  options.input.path = file;
  options.solve.method.reset();  // the method that suits the surface
  options.progress = show_progress;
  app::Journal journal(app::Verbosity::normal);
  view = std::make_unique<const app::View>(options, journal);
  return {200, "application/json", nlohmann::json({{"warnings", journal.warnings()}}).dump()};
}

viewer::Answer answer_of(std::string_view name, std::string_view body) try {
  if (name == "open") return open(std::string(body));
  return view ? view->session().answer(name, body) : failure(404, "no file is open");
} catch (const ResourceExhausted& error) {
  return failure(503, error.what());
} catch (const Error& error) {
  return failure(400, app::worded(error));
} catch (const std::bad_alloc&) {
  return failure(503, out_of_memory);
} catch (const std::exception& error) {
  return failure(500, error.what());
}

}  // namespace
}  // namespace ahm::web

using ahm::web::answer;

AHM_EXPORT(ahm_allocate) void* ahm_allocate(std::size_t bytes) { return std::malloc(bytes); }
AHM_EXPORT(ahm_free) void ahm_free(void* memory) { std::free(memory); }

/// Stores a file. @return 0 if memory is exhausted
AHM_EXPORT(ahm_file) int ahm_file(const char* name, std::size_t name_bytes, const char* bytes, std::size_t count) try {
  ahm::io::memory_files()[std::string(name, name_bytes)] = std::string(bytes, count);
  return 1;
} catch (const std::bad_alloc&) {
  return 0;
}

/// Answers a request: "open" with the name of a file, or a request of the session. @return HTTP status
AHM_EXPORT(ahm_request)
int ahm_request(const char* name, std::size_t name_bytes, const char* body, std::size_t body_bytes) {
  answer = {};
  answer = ahm::web::answer_of({name, name_bytes}, {body, body_bytes});
  return answer.status;
}
AHM_EXPORT(ahm_answer) const char* ahm_answer() { return answer.body.data(); }
AHM_EXPORT(ahm_answer_bytes) std::size_t ahm_answer_bytes() { return answer.body.size(); }
AHM_EXPORT(ahm_answer_type) const char* ahm_answer_type() { return answer.type.c_str(); }
// NOLINTEND(readability-identifier-naming)
