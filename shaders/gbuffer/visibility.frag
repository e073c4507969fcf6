// Which triangle a pixel shows: slot + 1, 0 is nothing.
#version 460
layout(location = 0) flat in uint slot;
layout(location = 0) out uint visible;

void main()
{
    visible = slot + 1u;
}
