/* Included by xxsubmod.c, not compiled by itself. */
static XXDouble XXLimit (XXDouble value, XXDouble most)
{
	return value > most ? most : value < -most ? -most : value;
}
