#include "kadans/app/program.h"

int main(int argc, char** argv) { return kadans::run_program(argc, argv); }
