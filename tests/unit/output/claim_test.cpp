#include "floe/output/claim.h"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "floe/error.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;

namespace {

/// What a claim writes of this process, with some of it changed.
std::string lock_with(const Scratch& scratch, const ordered_json& changes) {
  const Claim mine = claim_at(scratch / "sample", "sample");
  ordered_json j = ordered_json::parse(text_of(scratch / "sample"));
  j.update(changes);
  return j.dump() + "\n";
}

/// The number of a process that has ended.
int ended() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

void put(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("a claim names its process, counts for this one, and goes with its last copy") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const auto lock = scratch / "lock";
  {
    const Claim first = claim_at(lock, "folder");
    const ordered_json j = ordered_json::parse(text_of(lock));
    CHECK(j["pid"] == getpid());
    CHECK(!j["host"].get<std::string>().empty());
    CHECK(j["since"].get<std::string>().size() == 20);
    { const Claim again = claim_at(lock, "folder"); }
    const Claim copy = first;
    CHECK(std::filesystem::exists(lock));
  }
  CHECK(std::filesystem::is_empty(scratch / "."));
  const Claim claim = claim_at(lock, "folder");
  claim.release();
  CHECK_FALSE(std::filesystem::exists(lock));
}

TEST_CASE("a claim is refused where its holder lives, or may live; the words say which") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const auto lock = scratch / "lock";
  const int parent = getppid();
  std::ifstream stat("/proc/" + std::to_string(parent) + "/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), {});
  std::istringstream words(text.substr(text.rfind(')') + 2));
  std::string began;
  for (int i = 3; i <= 22; ++i) words >> began;
  put(lock, lock_with(scratch, {{"pid", parent}, {"began", began}}));
  CHECK_THROWS_AS(claim_at(lock, "folder 'x'"), InputError);
  CHECK_THROWS_WITH(
      claim_at(lock, "folder 'x'"),
      Contains("folder 'x': floe writes there (process " + std::to_string(parent) + " on ") && !Contains("remove"));
  put(lock, lock_with(scratch, {{"host", "elsewhere"}}));
  CHECK_THROWS_WITH(claim_at(lock, "folder"), Contains("on elsewhere, since 2") && Contains("remove " + lock.string()));
  put(lock, lock_with(scratch, {{"processes", "pid:[1]"}, {"pid", ended()}}));  // of a container
  CHECK_THROWS_WITH(claim_at(lock, "folder"), Contains("remove " + lock.string()));
  put(lock, "{\"host\": ");
  CHECK_THROWS_WITH(claim_at(lock, "folder"), Contains("cannot be read") && Contains("remove it"));
  CHECK(text_of(lock) == "{\"host\": ");
}

TEST_CASE("a claim of a process that is no more is taken over: ended, its number given anew, another boot") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const auto lock = scratch / "lock";
  for (const ordered_json& stale :
       {ordered_json{{"pid", ended()}}, ordered_json{{"began", "1"}}, ordered_json{{"boot", "before"}}}) {
    INFO(stale.dump());
    put(lock, lock_with(scratch, stale));
    const Claim claim = claim_at(lock, "folder");
    CHECK(ordered_json::parse(text_of(lock))["pid"] == getpid());
  }
  const pid_t zombie = fork();
  if (zombie == 0) {
    const Claim* kept = new Claim(claim_at(lock, "folder"));
    _exit(kept == nullptr);
  }
  siginfo_t state;
  REQUIRE(waitid(P_PID, zombie, &state, WEXITED | WNOWAIT) == 0);  // it has ended, and is still there
  {
    REQUIRE(ordered_json::parse(text_of(lock))["pid"] == zombie);
    const Claim claim = claim_at(lock, "folder");
    CHECK(ordered_json::parse(text_of(lock))["pid"] == getpid());
  }
  waitpid(zombie, nullptr, 0);
  CHECK(std::filesystem::is_empty(scratch / "."));
}

TEST_CASE("of many processes that find a stale claim, or none, one gets it") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  for (const bool stale : {true, false})
    for (int round = 0; round < 20; ++round) {
      const auto lock = scratch / ("lock" + std::to_string(stale) + "-" + std::to_string(round));
      if (stale) put(lock, lock_with(scratch, {{"pid", ended()}}));
      int gate[2], release[2];
      REQUIRE(pipe(gate) == 0);
      REQUIRE(pipe(release) == 0);
      std::vector<pid_t> children;
      for (int i = 0; i < 8; ++i) {
        const pid_t child = fork();
        if (child == 0) {
          char byte;
          close(gate[1]), close(release[1]);
          if (read(gate[0], &byte, 1) != 0) _exit(3);  // until the parent closes it
          try {
            const Claim claim = claim_at(lock, "folder");
            if (read(release[0], &byte, 1) != 0) _exit(3);
            _exit(0);  // as a killed process: the claim stays
          } catch (const InputError&) {
            _exit(2);
          } catch (const std::exception&) {
            _exit(1);
          }
        }
        children.push_back(child);
      }
      close(gate[1]);
      int got = 0, refused = 0, state = 0;
      for (int i = 0; i < 7; ++i) {  // those that do not get it end at once
        REQUIRE(wait(&state) > 0);
        refused += WIFEXITED(state) && WEXITSTATUS(state) == 2;
      }
      close(release[1]);
      REQUIRE(wait(&state) > 0);
      got = WIFEXITED(state) && WEXITSTATUS(state) == 0;
      close(gate[0]), close(release[0]);
      CHECK(refused == 7);
      CHECK(got == 1);
    }
}
