// Where the messages of a run go (base/log.h says them): to the sink of the scope that is open on their
// thread, or to standard error where none is.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <utility>

namespace plisse::log {

enum class Kind { info, notice, warning };
using Sink = std::function<void(Kind, std::string_view)>;

struct Receiver;  // a sink, and which warnings it has had

// What this thread says goes to `sink` until the scope ends, then again to where it went before; an empty
// sink drops it. A sink is called by one thread at a time; warn_once warns it once a key. Scopes of different
// threads do not see each other. Only the thread that opened a scope may end it.
class Scope {
 public:
  explicit Scope(Sink sink);
  explicit Scope(std::shared_ptr<Receiver> receiver);  // joins the scope of another thread; null: none
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

  static std::shared_ptr<Receiver> current();  // of this thread; null: none

 private:
  std::shared_ptr<Receiver> before_;
};

// For work on another thread: what it says goes where this thread's messages go now. Every task that may
// speak is made with it; TBB's tasks in this project compute and do not speak.
template <typename Work>
auto in_this_scope(Work work) {
  return [receiver = Scope::current(), work = std::move(work)]() mutable {
    const Scope scope(receiver);
    return work();
  };
}

}  // namespace plisse::log
