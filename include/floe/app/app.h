#pragma once

namespace floe::app {

/// The command line. Returns the exit code: 0 done, 1 the run failed, 2 the input is bad.
int main(int argc, char** argv);

}  // namespace floe::app
