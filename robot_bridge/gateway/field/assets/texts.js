/** What the page says, in the languages of its users; English is the key. */

export const LANGUAGES = { en: "English", hu: "Magyar", ca: "Català", es: "Español" };

const TEXTS = {
  "Robots": ["Robotok", "Robots", "Robots"],
  "Search": ["Keresés", "Cerca", "Buscar"],
  "Alarms": ["Riasztások", "Alarmes", "Alarmas"],
  "Settings": ["Beállítások", "Configuració", "Configuración"],
  "Language": ["Nyelv", "Idioma", "Idioma"],
  "Positions": ["Pozíciók", "Posicions", "Posiciones"],
  "as they change": ["változáskor", "quan canvien", "cuando cambian"],
  "asked for every 600 ms": ["lekérdezés 600 ms-onként", "demanades cada 600 ms", "consultadas cada 600 ms"],
  "Sign out": ["Kijelentkezés", "Tanca la sessió", "Cerrar sesión"],
  "Sign in": ["Bejelentkezés", "Inicia la sessió", "Iniciar sesión"],
  "Token of your account": ["A fiók tokenje", "Testimoni del vostre compte", "Token de su cuenta"],
  "Remember it on this phone": ["Megjegyzés ezen a telefonon", "Recorda'l en aquest telèfon", "Recordarlo en este teléfono"],
  "Menu": ["Menü", "Menú", "Menú"],
  "Map": ["Térkép", "Mapa", "Mapa"],
  "Close": ["Bezárás", "Tanca", "Cerrar"],
  "Abort": ["Megszakítás", "Avorta", "Abortar"],
  "Pause": ["Szünet", "Pausa", "Pausar"],
  "Resume": ["Folytatás", "Reprèn", "Reanudar"],
  "Target on the map": ["Cél a térképen", "Destí al mapa", "Destino en el mapa"],
  "Target by coordinates": ["Cél koordinátákkal", "Destí per coordenades", "Destino por coordenadas"],
  "Coordinate system": ["Koordináta-rendszer", "Sistema de coordenades", "Sistema de coordenadas"],
  "Place a cone there": ["Bója lerakása ott", "Col·loca-hi un con", "Colocar un cono allí"],
  "Send": ["Küldés", "Envia", "Enviar"],
  "Cancel": ["Mégse", "Cancel·la", "Cancelar"],
  "My position": ["Saját pozíció", "La meva posició", "Mi posición"],
  "Whole site": ["Teljes terület", "Tot el recinte", "Todo el recinto"],
  "EMERGENCY STOP": ["VÉSZLEÁLLÍTÁS", "ATURADA D'EMERGÈNCIA", "PARADA DE EMERGENCIA"],
  "Clear the emergency stop": ["Vészleállítás feloldása", "Aixeca l'aturada d'emergència", "Levantar la parada de emergencia"],
  "Press again to clear it: robots may drive": [
    "Nyomja meg újra a feloldáshoz: a robotok elindulhatnak",
    "Premeu de nou per aixecar-la: els robots es podran moure",
    "Pulse de nuevo para levantarla: los robots podrán moverse",
  ],
  "connected": ["kapcsolódva", "connectat", "conectado"],
  "connecting": ["kapcsolódás", "s'està connectant", "conectando"],
  "not signed in": ["nincs bejelentkezve", "sense sessió", "sin sesión"],
  "no answer for {s} s": ["nincs válasz {s} s óta", "sense resposta des de fa {s} s", "sin respuesta desde hace {s} s"],
  "The gateway does not answer. Robots are shown where they were {s} s ago.": [
    "Az átjáró nem válaszol. A robotok {s} másodperccel ezelőtti helyükön látszanak.",
    "La passarel·la no respon. Els robots es mostren on eren fa {s} s.",
    "La pasarela no responde. Los robots se muestran donde estaban hace {s} s.",
  ],
  "Open this page at another gateway of the fleet:": [
    "Nyissa meg ezt az oldalt a flotta egy másik átjáróján:",
    "Obriu aquesta pàgina en una altra passarel·la de la flota:",
    "Abra esta página en otra pasarela de la flota:",
  ],
  "This phone has no network.": ["A telefonnak nincs hálózata.", "Aquest telèfon no té xarxa.", "Este teléfono no tiene red."],
  "Sending the stop…": ["A leállítás küldése…", "S'està enviant l'aturada…", "Enviando la parada…"],
  "NOT CONFIRMED for {s} s: the gateway does not answer. Use the robots' own stop buttons. It is tried again.": [
    "{s} s óta NINCS MEGERŐSÍTVE: az átjáró nem válaszol. Használja a robotok saját leállítógombját. Újra próbáljuk.",
    "SENSE CONFIRMAR des de fa {s} s: la passarel·la no respon. Feu servir el botó d'aturada dels robots. Es torna a provar.",
    "SIN CONFIRMAR desde hace {s} s: la pasarela no responde. Use el botón de parada de los robots. Se vuelve a intentar.",
  ],
  "NOT STOPPED: {reason}": ["NEM ÁLLT LE: {reason}", "NO ATURAT: {reason}", "NO PARADO: {reason}"],
  "this phone is not signed in. Use the robots' own stop buttons.": [
    "ez a telefon nincs bejelentkezve. Használja a robotok saját leállítógombját.",
    "aquest telèfon no té sessió. Feu servir el botó d'aturada dels robots.",
    "este teléfono no tiene sesión. Use el botón de parada de los robots.",
  ],
  "your role, {role}, may not stop robots. Use the robots' own stop buttons.": [
    "az Ön szerepe ({role}) nem állíthat le robotokat. Használja a robotok saját leállítógombját.",
    "el vostre rol, {role}, no pot aturar robots. Feu servir el botó d'aturada dels robots.",
    "su rol, {role}, no puede parar robots. Use el botón de parada de los robots.",
  ],
  "At {reached} of {of} gateways.": [
    "{of} átjáróból {reached} helyen érvényes.",
    "A {reached} de {of} passarel·les.",
    "En {reached} de {of} pasarelas.",
  ],
  "STOP IN FORCE, by {who}: {acknowledged} of {robots} robots have answered, {standing} stand.": [
    "LEÁLLÍTÁS ÉRVÉNYBEN, {who}: {robots} robotból {acknowledged} válaszolt, {standing} áll.",
    "ATURADA EN VIGOR, per {who}: han respost {acknowledged} de {robots} robots, {standing} estan aturats.",
    "PARADA EN VIGOR, por {who}: han respondido {acknowledged} de {robots} robots, {standing} están parados.",
  ],
  "MOVING: {robots}": ["MOZOG: {robots}", "ES MOUEN: {robots}", "SE MUEVEN: {robots}"],
  "Not heard now, may move: {robots}": [
    "Most nem hallható, mozoghat: {robots}",
    "Ara no se'n sap res, es poden moure: {robots}",
    "Ahora no se sabe nada de ellos, pueden moverse: {robots}",
  ],
  "NOT REACHED: gateways {names}. Watch their robots.": [
    "NEM ÉRHETŐ EL: {names} átjáró. Figyelje a robotjaikat.",
    "NO S'HA ARRIBAT a les passarel·les {names}. Vigileu-ne els robots.",
    "NO SE HA LLEGADO a las pasarelas {names}. Vigile sus robots.",
  ],
  "Not answered: {robots}": ["Nem válaszolt: {robots}", "No han respost: {robots}", "No han respondido: {robots}"],
  "Refused: {robots}": ["Megtagadta: {robots}", "Han refusat: {robots}", "Han rechazado: {robots}"],
  "It is not in the database yet; it holds all the same.": [
    "Még nincs az adatbázisban; ettől függetlenül érvényes.",
    "Encara no és a la base de dades; igualment és vigent.",
    "Aún no está en la base de datos; está en vigor igualmente.",
  ],
  "fresh": ["friss", "actual", "actual"],
  "stale": ["elavult", "antic", "antiguo"],
  "may be elsewhere": ["lehet, hogy máshol van", "pot ser en un altre lloc", "puede estar en otro lugar"],
  "{robot} may be elsewhere": [
    "{robot}: lehet, hogy máshol van",
    "{robot} pot ser en un altre lloc",
    "{robot} puede estar en otro lugar",
  ],
  "lost": ["elveszett", "perdut", "perdido"],
  "offline": ["nem elérhető", "fora de línia", "desconectado"],
  "stopped": ["leállt", "aturat", "parado"],
  "heard {s} s ago": ["{s} s óta hallottuk", "escoltat fa {s} s", "oído hace {s} s"],
  "position {s} s old": ["pozíció {s} s régi", "posició de fa {s} s", "posición de hace {s} s"],
  "has not said where it is": ["nem mondta meg, hol van", "no ha dit on és", "no ha dicho dónde está"],
  "battery {n} %": ["akku {n} %", "bateria {n} %", "batería {n} %"],
  "Last task: {task}": ["Utolsó feladat: {task}", "Última tasca: {task}", "Última tarea: {task}"],
  "sent": ["elküldve", "enviat", "enviado"],
  "Refused: {reason}": ["Elutasítva: {reason}", "Refusat: {reason}", "Rechazado: {reason}"],
  "No answer: it is not known whether this was done. Look at the last task.": [
    "Nincs válasz: nem tudni, megtörtént-e. Nézze meg az utolsó feladatot.",
    "Sense resposta: no se sap si s'ha fet. Mireu l'última tasca.",
    "Sin respuesta: no se sabe si se hizo. Mire la última tarea.",
  ],
  "Not sent: the gateway does not answer.": ["Nincs elküldve: az átjáró nem válaszol.", "No enviat: la passarel·la no respon.", "No enviado: la pasarela no responde."],
  "Your role, {role}, may only look.": ["Az Ön szerepe ({role}) csak nézhet.", "El vostre rol, {role}, només pot mirar.", "Su rol, {role}, solo puede mirar."],
  "Target of {robot}": ["{robot} célja", "Destí de {robot}", "Destino de {robot}"],
  "Tap the place on the map.": ["Koppintson a helyre a térképen.", "Toqueu el lloc al mapa.", "Toque el lugar en el mapa."],
  "To {place}. Tap elsewhere to change it, then send.": [
    "Ide: {place}. Máshová koppintva módosítható, majd küldés.",
    "A {place}. Toqueu un altre lloc per canviar-lo i envieu.",
    "A {place}. Toque otro lugar para cambiarlo y envíe.",
  ],
  "Enter the coordinates, then send.": ["Írja be a koordinátákat, majd küldje el.", "Introduïu les coordenades i envieu.", "Introduzca las coordenadas y envíe."],
  "Longitude, degrees": ["Hosszúság, fok", "Longitud, graus", "Longitud, grados"],
  "Latitude, degrees": ["Szélesség, fok", "Latitud, graus", "Latitud, grados"],
  "x (easting), metres": ["x (kelet), méter", "x (est), metres", "x (este), metros"],
  "y (northing), metres": ["y (észak), méter", "y (nord), metres", "y (norte), metros"],
  "{text} is not a number": ["{text} nem szám", "{text} no és un nombre", "{text} no es un número"],
  "{n} more alarms": ["még {n} riasztás", "{n} alarmes més", "{n} alarmas más"],
  "{n} more: search for them": ["még {n}: keressen rájuk", "{n} més: cerqueu-los", "{n} más: búsquelos"],
  "Robots here: {n} of {all}.": ["Robotok itt: {n}, összesen {all}.", "Robots aquí: {n} de {all}.", "Robots aquí: {n} de {all}."],
  "Robots here: {n} of {all}. Zoom in to see each.": [
    "Robotok itt: {n}, összesen {all}. Nagyítson, hogy mindegyik látható legyen.",
    "Robots aquí: {n} de {all}. Amplieu el mapa per veure'ls un a un.",
    "Robots aquí: {n} de {all}. Amplíe el mapa para verlos uno a uno.",
  ],
  "no robots": ["nincs robot", "cap robot", "ningún robot"],
  "none": ["nincs", "cap", "ninguna"],
  "{robot} is lost": ["{robot} elveszett", "{robot} s'ha perdut", "{robot} se ha perdido"],
  "{robot} is in {name}": ["{robot} itt van: {name}", "{robot} és a {name}", "{robot} está en {name}"],
  "{seen} is {m} m from {robot}": ["{seen} {m} m-re van tőle: {robot}", "{seen} és a {m} m de {robot}", "{seen} está a {m} m de {robot}"],
  "link {link}: {text}": ["{link} kapcsolat: {text}", "enllaç {link}: {text}", "enlace {link}: {text}"],
  "robot {robot} is kept out: {text}": ["{robot} ki van zárva: {text}", "{robot} està exclòs: {text}", "{robot} está excluido: {text}"],
  "{kb} kB in the last minute": ["{kb} kB az elmúlt percben", "{kb} kB en l'últim minut", "{kb} kB en el último minuto"],
  "{name}, {role}": ["{name}, {role}", "{name}, {role}", "{name}, {role}"],
  "The background map does not answer; everything else works.": [
    "A háttértérkép nem válaszol; minden más működik.",
    "El mapa de fons no respon; la resta funciona.",
    "El mapa de fondo no responde; el resto funciona.",
  ],
  "Too much to draw: {what} are not all shown.": ["Túl sok rajzolnivaló: {what} nem látszik mind.", "Massa per dibuixar: {what} no es mostren tots.", "Demasiado para dibujar: {what} no se muestran todos."],
  "The gateway has been upgraded from {old} to {new}.": ["Az átjáró frissült: {old} → {new}.", "La passarel·la s'ha actualitzat de {old} a {new}.", "La pasarela se ha actualizado de {old} a {new}."],
  "Load the new page": ["Új oldal betöltése", "Carrega la pàgina nova", "Cargar la página nueva"],
  "A token in the address is in logs and histories. Have it replaced, and sign in below.": [
    "A címben lévő token naplókba és előzményekbe kerül. Cseréltesse le, és jelentkezzen be alább.",
    "Un testimoni a l'adreça queda en registres i historials. Feu-lo canviar i inicieu la sessió a sota.",
    "Un token en la dirección queda en registros e historiales. Haga que lo cambien e inicie sesión abajo.",
  ],
  "The site is not drawn: {reason}": ["A terület nem rajzolható: {reason}", "El recinte no es dibuixa: {reason}", "El recinto no se dibuja: {reason}"],
  "This phone does not say where it is: {reason}": ["A telefon nem mondja meg, hol van: {reason}", "Aquest telèfon no diu on és: {reason}", "Este teléfono no dice dónde está: {reason}"],
  "The position of a phone is given to pages with https only.": [
    "A telefon pozícióját csak https oldalak kapják meg.",
    "La posició del telèfon només es dona a pàgines amb https.",
    "La posición del teléfono solo se da a páginas con https.",
  ],
  "A stop by {who} was in force {s} s ago. It may have been cleared since: the gateway does not answer.": [
    "{s} másodperce {who} leállítása érvényben volt. Azóta feloldhatták: az átjáró nem válaszol.",
    "Fa {s} s una aturada de {who} era en vigor. Pot haver estat aixecada des de llavors: la passarel·la no respon.",
    "Hace {s} s una parada de {who} estaba en vigor. Puede haberse levantado desde entonces: la pasarela no responde.",
  ],
  "The stop was in force, and {who} has cleared it since.": [
    "A leállítás érvényben volt, és {who} azóta feloldotta.",
    "L'aturada era en vigor, i {who} l'ha aixecada des de llavors.",
    "La parada estaba en vigor, y {who} la ha levantado desde entonces.",
  ],
  "No answer: it is not known whether the stop was cleared.": [
    "Nincs válasz: nem tudni, feloldották-e a leállítást.",
    "Sense resposta: no se sap si l'aturada s'ha aixecat.",
    "Sin respuesta: no se sabe si la parada se levantó.",
  ],
  "Another site, or another fleet, is served now than before. What was being made was not sent. Look at the map.": [
    "Az eddigitől eltérő területet vagy flottát szolgál ki az átjáró. Ami készülőben volt, nem lett elküldve. Nézze meg a térképet.",
    "Ara se serveix un altre recinte o una altra flota que abans. El que s'estava preparant no s'ha enviat. Mireu el mapa.",
    "Ahora se sirve otro recinto u otra flota que antes. Lo que se estaba preparando no se ha enviado. Mire el mapa.",
  ],
  "{robot} was removed.": ["{robot} el lett távolítva.", "{robot} s'ha eliminat.", "{robot} se ha eliminado."],
  "was {state}": ["korábban: {state}", "abans: {state}", "antes: {state}"],
  "something that holds robots was pressed since": [
    "azóta robotokat megállító gombot nyomtak meg",
    "des de llavors s'ha premut un botó que atura robots",
    "desde entonces se ha pulsado un botón que detiene robots",
  ],
  "You are here, within {m} m": ["Ön itt van, {m} m pontossággal", "Sou aquí, amb {m} m de precisió", "Está aquí, con {m} m de precisión"],
};

const ORDER = ["hu", "ca", "es"];
let chosen = "en";

/** Return the language to begin with: the one chosen before, else the phone's, else English. */
export function firstLanguage(stored, preferred) {
  for (const one of [stored, ...preferred]) {
    const short = String(one ?? "").slice(0, 2).toLowerCase();
    if (short in LANGUAGES) return short;
  }
  return "en";
}

export function setLanguage(language) {
  chosen = language in LANGUAGES ? language : "en";
  document.documentElement.lang = chosen;
}

/** Return `text` in the chosen language, with {names} replaced by `values`. */
export function tr(text, values = {}) {
  const there = TEXTS[text]?.[ORDER.indexOf(chosen)] ?? text;
  return there.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}

/** Set the texts of all elements that name theirs. */
export function translatePage() {
  for (const element of document.querySelectorAll("[data-text]")) element.textContent = tr(element.dataset.text);
}

/** Every text, for the tests. */
export const ALL = TEXTS;
