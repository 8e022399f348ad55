/* clang-format off */
#ifndef XX_SUBMOD_H
#define XX_SUBMOD_H

#include "xxmodel.h"

void XXInitializeSubmodel (XXDouble *u, XXDouble *y, XXDouble t);
void XXCalculateSubmodel (XXDouble *u, XXDouble *y, XXDouble t);
void XXTerminateSubmodel (XXDouble *u, XXDouble *y, XXDouble t);

#endif
