#include "floe/app/app.h"

int main(int argc, char** argv) { return floe::app::main(argc, argv); }
