#include "studies/driver/command_line.hpp"

int main(int argc, char** argv) { return concord::studies::main_program(argc, argv); }
