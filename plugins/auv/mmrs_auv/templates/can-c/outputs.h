/* What drives need of the hardware: outputs.c has it, and is yours. */
#ifndef OUTPUTS_H
#define OUTPUTS_H

#include <stdbool.h>

/* Have a thruster push with so many newtons; negative: the other way. Called at every tick and command. */
void outputs_set(unsigned thruster, double newtons);

/* Return whether the motor of a thruster, or what feeds it, has failed. */
bool outputs_failed(unsigned thruster);

/* Return whether the vehicle is deeper than half a metre; told: what pressure on the bus said last, false
 * before it said anything. Once nobody commands any drive down there, the drop weight falls. */
bool outputs_deep(bool told);

/* Let go of the drop weight. Called once. */
void outputs_release(void);

#endif
