// Of what is drawn about the robot's balance, in the picture and on the buttons that show it.
export const mark_colors = { force: 0x2f9e6e, cop: 0x2f9e6e, com: 0xd9822b, dcm: 0xb8479b, support: 0x3b82c4 };
