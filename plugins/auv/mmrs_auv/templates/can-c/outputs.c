/* The hardware of the drives. This file is yours: it is never overwritten. */
#include "outputs.h"

void outputs_set(unsigned thruster, double newtons)
{
    (void)thruster;
    (void)newtons; /* write the set-point of the motor controller here */
}

bool outputs_failed(unsigned thruster)
{
    (void)thruster;
    return false; /* ask the motor controller for its faults here */
}

bool outputs_deep(bool told)
{
    return told; /* ask a pressure switch of this board, if it has one, that knows when the bus is gone */
}

void outputs_release(void)
{
    /* let go of the drop weight here, if this board holds it */
}
