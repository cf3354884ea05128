// Reads a scene of the library: the problem statement without any method.

#include "scene/reader.hpp"

int main() { return concord::scene::read_problem("swinging_cube").material.E == 17e6 ? 0 : 1; }
