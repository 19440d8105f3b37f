// Signals, each in a process of its own: the first is noted, the second ends.
#include "base/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plisse {
namespace {

// The exit status of a process that ran `body`, as waitpid gives it.
template <typename Body>
int status_of(const Body& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Interrupt, FirstSignalIsNotedAndTheRunGoesOn) {
  for (const int number : {SIGINT, SIGTERM}) {
    const int status = status_of([number] {
      install_interrupt_handlers();
      if (interrupted() || signal_number() != 0) return 1;
      raise(number);
      return interrupted() && signal_number() == number ? 42 : 2;
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 42) << number;
  }
}

TEST(Interrupt, SecondSignalEndsAtOnceWithItsCode) {
  const int status = status_of([] {
    install_interrupt_handlers();
    raise(SIGINT);
    raise(SIGINT);
    return 42;
  });
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
}

}  // namespace
}  // namespace plisse
