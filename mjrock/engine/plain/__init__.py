"""Plain models: solids whose contacts MuJoCo finds itself, with the law of the joints in each pair."""
