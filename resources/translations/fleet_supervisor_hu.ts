<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="hu" sourcelanguage="en">
    <context>
        <name>FleetSupervisor</name>
        <message numerus="yes">
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>%n accounts</source>
            <translation>
                <numerusform>%n fiók</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Add…</source>
            <translation>&amp;Hozzáadás…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Name</source>
            <translation>&amp;Név</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Role</source>
            <translation>&amp;Szerep</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>&amp;Token holds</source>
            <translation>&amp;Token érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts</source>
            <translation>Fiókok</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Accounts…</source>
            <translation>Fiókok…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Cancel</source>
            <translation>Mégse</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change &amp;role…</source>
            <translation>&amp;Szerep módosítása…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Change role</source>
            <translation>Szerep módosítása</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Last connected</source>
            <translation>Utoljára kapcsolódva</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make account</source>
            <translation>Fiók létrehozása</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Make token</source>
            <translation>Token készítése</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New &amp;token…</source>
            <translation>Új &amp;token…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account</source>
            <translation>Új fiók</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New account {operator}</source>
            <translation>Új fiók: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>New token for {operator}</source>
            <translation>Új token: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Operator</source>
            <translation>Kezelő</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;fresh</source>
            <translation>&amp;Frissítés</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Re&amp;voke…</source>
            <translation>&amp;Visszavonás…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke</source>
            <translation>Visszavonás</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke the token of {operator}?</source>
            <translation>Visszavonja {operator} tokenjét?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Revoke {operator}</source>
            <translation>Visszavonás: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role</source>
            <translation>Szerep</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Role of {operator}</source>
            <translation>{operator} szerepe</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Since</source>
            <translation>Ettől</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The gateway makes a token for the account. It is shown once, to be handed over.</source>
            <translation>Az átjáró tokent készít a fiókhoz. Egyszer látható, hogy át lehessen adni.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} ends at once, with every connection that it opened. The account stays, and a new token can be made for it. Robots go on with what they were told.</source>
            <translation>{operator} tokenje azonnal érvényét veszti, és vele minden kapcsolat, amelyet megnyitott. A fiók megmarad, új token készíthető hozzá. A robotok folytatják, amit mondtak nekik.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is made.</source>
            <translation>{operator} tokenje elkészült.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>The token of {operator} is revoked.</source>
            <translation>{operator} tokenje visszavonva.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts yet: everybody on its computer may do everything. The first account ends that for good, and this connection too: connect again with its token. It has to be a supervisor's.</source>
            <translation>Ezen az átjárón még nincsenek fiókok: a számítógépén bárki bármit megtehet. Az első fiók végleg véget vet ennek, és ennek a kapcsolatnak is: kapcsolódjon újra a tokenjével. Felügyelőé kell hogy legyen.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This gateway has no accounts: everybody on its computer may do everything. The first account, a supervisor's, ends that.</source>
            <translation>Ezen az átjárón nincsenek fiókok: a számítógépén bárki bármit megtehet. Az első fiók, egy felügyelőé, véget vet ennek.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off and does not come back by itself.</source>
            <translation>Ez az Ön saját fiókja: ez a kezelőpult lekapcsolódik, és magától nem tér vissza.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: this desk is cut off until you enter the new token.</source>
            <translation>Ez az Ön saját fiókja: ez a kezelőpult lekapcsolódik, amíg meg nem adja az új tokent.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>This is your own account: without being a supervisor you cannot undo it.</source>
            <translation>Ez az Ön saját fiókja: ha nem felügyelő, nem vonhatja vissza.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Token</source>
            <translation>Token</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>Who may connect to the gateway and do what; takes a supervisor</source>
            <translation>Ki kapcsolódhat az átjáróhoz és mit tehet; felügyelő kell hozzá</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>connected now</source>
            <translation>most kapcsolódva</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>expired {time}</source>
            <translation>lejárt: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 day</source>
            <translation>1 napra</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 1 year</source>
            <translation>1 évre</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 30 days</source>
            <translation>30 napra</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 7 days</source>
            <translation>7 napra</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>for 90 days</source>
            <translation>90 napra</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>holds until {time}</source>
            <translation>érvényes eddig: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>none</source>
            <translation>nincs</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>revoked {time}</source>
            <translation>visszavonva: {time}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>until it is revoked</source>
            <translation>amíg vissza nem vonják</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} (you)</source>
            <translation>{operator} (Ön)</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} gets a new token. The one before ends at once, with every connection that it opened.</source>
            <translation>{operator} új tokent kap. Az előző azonnal érvényét veszti, és vele minden kapcsolat, amelyet megnyitott.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role} now.</source>
            <translation>{operator} szerepe mostantól: {role}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/accounts_dialog.py" />
            <source>{operator} is {role}. Another role holds from the next thing on that is asked for, also over connections that are open.</source>
            <translation>{operator} szerepe: {role}. Másik szerep a következő kéréstől érvényes, a nyitott kapcsolatokon is.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source> s</source>
            <translation> s</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n robots were not removed: {why}</source>
            <translation>
                <numerusform>%n robot nem lett eltávolítva: {why}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n robots were removed: {names}</source>
            <translation>
                <numerusform>%n robot eltávolítva: {names}</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>%n sites</source>
            <translation>
                <numerusform>%n telephely</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Link</source>
            <translation>&amp;Kapcsolat</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Paused</source>
            <translation>&amp;Szünetel</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Robots</source>
            <translation>&amp;Robotok</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Serve this site…</source>
            <translation>E telephely &amp;kiszolgálása…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>&amp;Speed</source>
            <translation>Se&amp;besség</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Every robot is sent the map of {site} ({folder}), every desk shows it, and it is served until another one is chosen, also by a gateway that is started anew.</source>
            <translation>Minden robot megkapja {site} ({folder}) térképét, minden kezelőpult ezt mutatja, és addig ezt szolgálja ki az átjáró, újraindítva is, amíg másikat nem választanak.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Folder</source>
            <translation>Mappa</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>From the &amp;beginning again at its end</source>
            <translation>A végén elölről &amp;kezdi</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No link plays a recording at this gateway.</source>
            <translation>Ennél az átjárónál egy kapcsolat sem játszik le felvételt.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is lost or offline.</source>
            <translation>Egy robot sem elveszett vagy offline.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot is stopped: commands and queues go on in the same metres, whatever roads and keepouts the new site has there. Stop robots first where that matters.</source>
            <translation>Egyik robot sem áll meg: a parancsok és várólisták ugyanazokban a méterekben folytatódnak, bármilyen utak és tiltott területek vannak ott az új telephelyen. Ahol ez számít, előbb állítsa meg a robotokat.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>No robot was removed: {why}</source>
            <translation>Egy robot sem lett eltávolítva: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>None is stopped by that. One that comes back is told to abort what it still does, and is a new robot.</source>
            <translation>Ez egyik robotot sem állítja meg. Amelyik visszatér, utasítást kap, hogy szakítsa meg, amit még csinál, és új robotnak számít.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Others cannot be chosen here.</source>
            <translation>Mások itt nem választhatók.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Pl&amp;ace</source>
            <translation>&amp;Hely</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recording of {link}</source>
            <translation>{link} felvétele</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings on the map</source>
            <translation>Felvételek a térképen</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings that links play on the map: pause, speed, place</source>
            <translation>Felvételek, amelyeket kapcsolatok a térképen lejátszanak: szünet, sebesség, hely</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Recordings…</source>
            <translation>Felvételek…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove</source>
            <translation>Eltávolítás</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots that are gone?</source>
            <translation>Eltávolítja az eltűnt robotokat?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove robots…</source>
            <translation>Robotok eltávolítása…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Remove {names}</source>
            <translation>Eltávolítás: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Seconds after the beginning</source>
            <translation>Másodperc a kezdettől</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve this site</source>
            <translation>Kiszolgálás</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}</source>
            <translation>Kiszolgálás: {site}</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Serve {site}?</source>
            <translation>Ezt szolgálja ki: {site}?</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site</source>
            <translation>Telephely</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Sites</source>
            <translation>Telephelyek</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Site…</source>
            <translation>Telephely…</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>State</source>
            <translation>Állapot</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Take robots that are lost or offline off every desk; takes a supervisor</source>
            <translation>Elveszett vagy offline robotok levétele minden kezelőpultról; felügyelő kell hozzá</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>The desk is not connected to a gateway. Press Connect first.</source>
            <translation>A kezelőpult nincs átjáróhoz kapcsolva. Előbb nyomja meg a Kapcsolódás gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>They go from every desk. What is in their queues is removed, what they were told and have not done has failed; what they did stays stored.</source>
            <translation>Minden kezelőpultról eltűnnek. A várólistájuk kiürül, az el nem végzett parancsaik meghiúsulnak; amit elvégeztek, tárolva marad.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Version</source>
            <translation>Verzió</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which of the published sites the gateway serves; takes a supervisor</source>
            <translation>Melyik közzétett telephelyet szolgálja ki az átjáró; felügyelő kell hozzá</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Which site is served</source>
            <translation>Melyik telephelyet szolgálja ki</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>Why, for the log</source>
            <translation>Miért, a naplóhoz</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>all %n that are lost or offline</source>
            <translation>
                <numerusform>mind a(z) %n elveszett vagy offline</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>can be chosen</source>
            <translation>választható</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>served now</source>
            <translation>most ezt szolgálja ki</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/admin/supervision.py" />
            <source>the %n selected ones</source>
            <translation>
                <numerusform>a kijelölt %n</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>{file}: {place} s of {length} s</source>
            <translation>{file}: {place} s / {length} s</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervision.py" />
            <source>{site} is served now.</source>
            <translation>Most ezt szolgálja ki: {site}.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>Asking the gateway …</source>
            <translation>Az átjáró kérdezése …</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This gateway says nothing of roles: it is older than accounts. Update it.</source>
            <translation>Ez az átjáró nem mond szerepeket: régebbi, mint a fiókok. Frissítse.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>This takes a supervisor, and {operator} is {role} here. If that was changed meanwhile, disconnect and connect again.</source>
            <translation>Ehhez felügyelő kell, és {operator} szerepe itt: {role}. Ha ez közben megváltozott, bontsa a kapcsolatot, és kapcsolódjon újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/supervisor_dialog.py" />
            <source>{words}: the gateway's answer cannot be read ({kind}). Update the gateway or the plugin, whichever is older.</source>
            <translation>{words}: az átjáró válasza nem olvasható ({kind}). Frissítse az átjárót vagy a bővítményt, amelyik régebbi.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>&amp;Copy</source>
            <translation>&amp;Másolás</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>A phone whose camera reads this code opens the field page, signed in with the token:</source>
            <translation>A telefon, amelynek kamerája leolvassa ezt a kódot, megnyitja a helyszíni oldalt, a tokennel bejelentkezve:</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Code for a phone</source>
            <translation>Kód telefonhoz</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Copied. It stays in the clipboard until something else is copied.</source>
            <translation>Kimásolva. A vágólapon marad, amíg mást nem másol.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>For a phone: connect this desk by the address that phones reach the gateway by, not by {host}, and a new token has a code here that opens the field page.</source>
            <translation>Telefonhoz: ezt a kezelőpultot azon a címen csatlakoztassa, amelyen a telefonok elérik az átjárót, ne a(z) {host} címen; az új token mellett akkor itt egy kód áll, amely megnyitja a helyszíni oldalt.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>The Python package segno is missing, which draws the code for phones. Install the plugin from its release zip, which contains it.</source>
            <translation>Hiányzik a segno Python-csomag, amely a telefonoknak szóló kódot rajzolja. Telepítse a bővítményt a kiadás zip-fájljából, amely tartalmazza.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>This desk was connected with what the token takes the place of, and is cut off. Enter the token in the Fleet panel under Access, then press Connect.</source>
            <translation>Ez a kezelőpult azzal volt kapcsolódva, aminek a token a helyébe lép, ezért lekapcsolódik. Adja meg a tokent a Flotta panelen a Hozzáférés alatt, majd nyomja meg a Kapcsolódás gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>Token of {operator}</source>
            <translation>{operator} tokenje</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>holds</source>
            <translation>érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/admin/token_dialog.py" />
            <source>{operator}, {role}: the token {until}. It is shown now and never again, and kept nowhere: hand it over on a way that others do not read. If it gets lost, make a new one.</source>
            <translation>{operator}, {role}: a token {until}. Most látható és soha többé, és sehol sem őrződik meg: olyan úton adja át, amelyet mások nem olvasnak. Ha elvész, készítsen újat.</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Across the base of a cone; the cones touch the track's limits</source>
            <translation>A bója talpának szélessége; a bóják a pálya szélét érintik</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Braking lane</source>
            <translation>Fékezősáv</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the corridor</source>
            <translation>A folyosó szabad szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the gates</source>
            <translation>A kapuk szabad szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the lane</source>
            <translation>A sáv szabad szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the track</source>
            <translation>A pálya szabad szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Clear width of the ways in and out</source>
            <translation>A be- és kivezető út szabad szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones inside each inner circle</source>
            <translation>Bóják minden belső körön belül</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones on each side of each lane</source>
            <translation>Bóják minden sáv mindkét oldalán</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones outside each outer circle</source>
            <translation>Bóják minden külső körön kívül</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the end of the lane</source>
            <translation>A sáv végét lezáró bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones that close the way out</source>
            <translation>A kivezető utat lezáró bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Cones to go round</source>
            <translation>Megkerülendő bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Constant-radius circle</source>
            <translation>Állandó sugarú kör</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Corridor</source>
            <translation>Folyosó</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the inner circles</source>
            <translation>A belső körök átmérője</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Diameter of the outer circles</source>
            <translation>A külső körök átmérője</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Double lane change</source>
            <translation>Kettős sávváltás</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 4.1</source>
            <translation>Formula Student szabályzat, D 4.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student Rules, D 5.1</source>
            <translation>Formula Student szabályzat, D 5.1</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student acceleration</source>
            <translation>Formula Student gyorsulás</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Formula Student skid pad</source>
            <translation>Formula Student nyolcas kör (skid pad)</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a gate to the nearest cone</source>
            <translation>Egy kaputól a legközelebbi bójáig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From a line to the big cones before and behind it</source>
            <translation>Egy vonaltól az előtte és mögötte álló nagy bójákig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From centre to centre of the circles</source>
            <translation>A körök középpontjától középpontjáig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone</source>
            <translation>Bójától bójáig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the lane</source>
            <translation>Bójától bójáig a sáv mentén</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the middle of the lane</source>
            <translation>Bójától bójáig a sáv közepe mentén</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the track</source>
            <translation>Bójától bójáig a pálya mentén</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From cone to cone along the ways in and out</source>
            <translation>Bójától bójáig a be- és kivezető út mentén</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From pair to pair</source>
            <translation>Pártól párig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the left limit of the entry lane to the right one of the side lane</source>
            <translation>A bevezető sáv bal szélétől az oldalsó sáv jobb széléig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the meeting point to the first cones of the ways in and out</source>
            <translation>A találkozási ponttól a be- és kivezető út első bójáiig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the middle of the path to these cones</source>
            <translation>Az út közepétől ezekig a bójákig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the right limit of the entry lane to that of the side lane</source>
            <translation>A bevezető sáv jobb szélétől az oldalsó sávéig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the starting line to the finish line</source>
            <translation>A rajtvonaltól a célvonalig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>From the timing line to the big cones before and behind it</source>
            <translation>Az időmérő vonaltól az előtte és mögötte álló nagy bójákig</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>ISO 4138:2021, method 1</source>
            <translation>ISO 4138:2021, 1. módszer</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane before braking begins</source>
            <translation>Sáv a fékezés kezdete előtt</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Lane to stop in behind the finish line</source>
            <translation>Megállósáv a célvonal mögött</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Least width of the exit lane</source>
            <translation>A kivezető sáv legkisebb szélessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the corridor</source>
            <translation>A folyosó hossza</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way in that has cones</source>
            <translation>A bevezető út bójás hossza</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Length of the way out that has cones</source>
            <translation>A kivezető út bójás hossza</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Obstacle avoidance</source>
            <translation>Akadálykikerülés</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Part of each outer circle that has cones</source>
            <translation>A külső körök bójás része</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Radius of the middle of the lane</source>
            <translation>A sáv közepének sugara</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 1: entry lane</source>
            <translation>1. szakasz: bevezető sáv</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 2: way to the side lane</source>
            <translation>2. szakasz: út az oldalsó sávba</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 3: side lane</source>
            <translation>3. szakasz: oldalsó sáv</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 4: way back</source>
            <translation>4. szakasz: visszaút</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Section 5: exit lane</source>
            <translation>5. szakasz: kivezető sáv</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Sections 5 and 6: exit lane</source>
            <translation>5. és 6. szakasz: kivezető sáv</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Slalom</source>
            <translation>Szlalom</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Speed at which braking begins</source>
            <translation>A fékezés kezdetének sebessége</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>To which side it goes first</source>
            <translation>Először melyik oldalra megy</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the entry lane</source>
            <translation>Járműszélességek a bevezető sáv szélességében</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the exit lane</source>
            <translation>Járműszélességek a kivezető sáv szélességében</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Vehicle widths in the width of the side lane</source>
            <translation>Járműszélességek az oldalsó sáv szélességében</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to each of these widths</source>
            <translation>Amennyi ezekhez a szélességekhez hozzáadódik</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the entry lane</source>
            <translation>Amennyi a bevezető sáv szélességéhez hozzáadódik</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the exit lane</source>
            <translation>Amennyi a kivezető sáv szélességéhez hozzáadódik</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What is added to the width of the side lane</source>
            <translation>Amennyi az oldalsó sáv szélességéhez hozzáadódik</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>What of the exit lane is in line with the entry lane</source>
            <translation>A kivezető sáv mely része esik egy vonalba a bevezetővel</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Which way it is driven</source>
            <translation>Merre kell körbemenni</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>Width of the vehicle without mirrors</source>
            <translation>A jármű szélessége tükrök nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>collect them</source>
            <translation>begyűjtés</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>done as early as possible</source>
            <translation>mielőbb kész legyen</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive back</source>
            <translation>menjenek vissza</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>drive to a store</source>
            <translation>menjenek raktárhoz</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>fewest metres</source>
            <translation>legkevesebb méter</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a number</source>
            <translation>adjon meg egy számot</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give a whole number</source>
            <translation>adjon meg egy egész számot</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give one of {choices}</source>
            <translation>ezek közül adjon meg egyet: {choices}</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>give {least:g} or more</source>
            <translation>legalább {least:g} kell</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left</source>
            <translation>balra</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>left limit</source>
            <translation>bal széle</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>length after UN R13-H; test after ISO 21994</source>
            <translation>hossza az UN R13-H, a vizsgálat az ISO 21994 szerint</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>middle</source>
            <translation>közepe</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: 18 m as European testers drive it</source>
            <translation>nem szabvány: 18 m, ahogy az európai tesztelők hajtják</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>no standard: colours, width and spacing of Formula Student</source>
            <translation>nem szabvány: a Formula Student színei, szélessége és távolságai</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>place them</source>
            <translation>kihelyezés</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>quick preview</source>
            <translation>gyors előnézet</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right</source>
            <translation>jobbra</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>right limit</source>
            <translation>jobb széle</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved</source>
            <translation>megoldva</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>solved: nothing better than the preview was found</source>
            <translation>megoldva: az előnézetnél jobb nem került elő</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>stay where they are</source>
            <translation>maradjanak, ahol vannak</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the best that is installed</source>
            <translation>a telepítettek közül a legjobb</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>the preview: quick, not the best</source>
            <translation>az előnézet: gyors, nem a legjobb</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the left</source>
            <translation>balra</translation>
        </message>
        <message>
            <location filename="../../plugin/cone_texts.py" />
            <source>to the right</source>
            <translation>jobbra</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where a cone stands: {robot} put it down at {cone_x:.2f}, {cone_y:.2f}.</source>
            <translation>({x:.2f}, {y:.2f}) m helyén bója áll: {robot} rakta le itt: {cone_x:.2f}, {cone_y:.2f}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is where {robot} stands.</source>
            <translation>({x:.2f}, {y:.2f}) m helyén {robot} áll.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep {clear_m:g} m between targets.</source>
            <translation>({x:.2f}, {y:.2f}) m {away:.2f} m-re van ettől: {what}, {robot}, itt: {other_x:.2f}, {other_y:.2f}; tartson {clear_m:g} m-t a célok között.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>No layer of the project says where obstacles and keepouts are, so nobody has looked. Open the site's project, or give layers their roles.</source>
            <translation>A projekt egyik rétege sem mondja meg, hol vannak akadályok és tiltott területek, ezért ezt senki sem nézte. Nyissa meg a telephely projektjét, vagy adjon szerepet a rétegeknek.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} cannot be read, so what is in it was not looked at. Repair its source, or take its role away.</source>
            <translation>A(z) {layer} réteg nem olvasható, ezért a tartalmát senki sem nézte. Javítsa ki a forrását, vagy vegye el a szerepét.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has no CRS, so nobody knows where on the site it lies. Set it (Layer &gt; Set CRS of Layer), or take its role away.</source>
            <translation>A(z) {layer} rétegnek nincs vetülete, ezért senki sem tudja, hol fekszik a telephelyen. Állítsa be (Réteg &gt; Réteg vetületének beállítása), vagy vegye el a szerepét.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so what is in it was not looked at. Bring its server or drive back and try again, or take the role of the layer away.</source>
            <translation>A(z) {layer} réteg {seconds:g} másodperce nem válaszol, ezért a tartalmát senki sem nézte. Tegye újra elérhetővé a kiszolgálóját vagy a meghajtóját, és próbálja újra, vagy vegye el a réteg szerepét.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.</source>
            <translation>A projektnek nincs vetülete, ezért a térkép a telephelyében, {crs} vetületben értendő; más vetületű réteg rossz helyen látszik rajta. Válassza ki a projekt vetületét a QGIS jobb alsó sarkában.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>a task</source>
            <translation>egy feladat</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the end of the route</source>
            <translation>az útvonal vége</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>the target</source>
            <translation>a cél</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be sent to targets.</source>
            <translation>A(z) {robot} nem küldhető célhoz.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot be told where it starts.</source>
            <translation>A(z) {robot} robotnak nem adható meg, honnan indul.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} cannot follow routes.</source>
            <translation>A(z) {robot} nem tud útvonalat követni.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is at work for {operator} ({task}): sending this takes its place.</source>
            <translation>{robot} éppen {operator} megbízásán dolgozik ({task}): az elküldés ennek a helyébe lép.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is only seen: it takes no commands.</source>
            <translation>A(z) {robot} csak látható: parancsot nem fogad.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} is {state}: it is told this when it is heard again, if that is soon enough.</source>
            <translation>{robot}: {state}; ezt akkor kapja meg, amikor újra hallatszik, ha az elég hamar van.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones.</source>
            <translation>A(z) {robot} nem rak le bóját.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{robot} places no cones: it only drives there.</source>
            <translation>A(z) {robot} nem rak le bóját: csak odamegy.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/command_checks.py" />
            <source>{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to ({x_max:g}, {y_max:g}) m. Click inside it.</source>
            <translation>{where} m a(z) {name} telephelyen kívül van, amely ettől: ({x_min:g}, {y_min:g}), eddig terjed: ({x_max:g}, {y_max:g}) m. Kattintson belülre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude</source>
            <translation>szélesség, hosszúság</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>latitude, longitude, as in 48.2083, 16.3725</source>
            <translation>szélesség, hosszúság, mint 48.2083, 16.3725</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y</source>
            <translation>x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>x, y, as in 488070.50, 5190055.20</source>
            <translation>x, y, mint 488070.50, 5190055.20</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{shown!r} is no place: write {right}.</source>
            <translation>{shown!r} nem hely: írja így: {right}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is not on the site {name}; with its two numbers swapped it is. Write {order}: {first:.10g}, {second:.10g}.</source>
            <translation>{text!r} nincs a(z) {name} telephelyen; a két számot felcserélve ott van. Írja így, {order}: {first:.10g}, {second:.10g}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r} is {away:.0f} km outside the site {name}. Write {order}, and check the numbers and the CRS that they are in ({crs}).</source>
            <translation>{text!r} {away:.0f} km-rel a(z) {name} telephelyen kívül van. Írja így: {order}, és ellenőrizze a számokat és a vetületüket ({crs}).</translation>
        </message>
        <message>
            <location filename="../../plugin/control/coordinates.py" />
            <source>{text!r}: latitude {lat:g} and longitude {lon:g} are not on the earth; write latitude first, or choose the CRS that the numbers are in.</source>
            <translation>{text!r}: a {lat:g} szélesség és {lon:g} hosszúság nincs a Földön; a szélességet írja előbb, vagy válassza a számok vetületét.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Abort of {robot}</source>
            <translation>{robot} megszakítása</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>No robot is selected, so none was aborted. Select it in the table or on the map.</source>
            <translation>Nincs kijelölt robot, így egyik sem lett megszakítva. Jelölje ki a táblázatban vagy a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>Pause of {robot}</source>
            <translation>{robot} szüneteltetése</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>The operator's name is empty. Write who you are: it stands in every log.</source>
            <translation>A kezelő neve üres. Írja be, ki Ön: minden naplóban ott áll.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>This gateway serves another site than the rest of the fleet: {reason}.</source>
            <translation>Ez az átjáró más telephelyet szolgál ki, mint a flotta többi része: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: another site is served now. Draw it anew.</source>
            <translation>{words}: nem lett elküldve, mert már másik telephely van szolgáltatva. Rajzolja meg újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/fleet_controller.py" />
            <source>{words} was not sent: robot {robot} was removed.</source>
            <translation>{words}: nem lett elküldve, mert a(z) {robot} robotot eltávolították.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>({x:.2f}, {y:.2f}) m</source>
            <translation>({x:.2f}, {y:.2f}) m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not seen. Correct its CRS, or take its role away.</source>
            <translation>A(z) {layer} réteg nem helyezhető a telephelyre ({error}), így az akadályai nem látszanak. Javítsa ki a vetületét, vagy vegye el a szerepét.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The route</source>
            <translation>Az útvonal</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to}</source>
            <translation>Az út ide: {to}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>The way to {to} leaves the road surface.</source>
            <translation>A(z) {to} helyhez vezető út letér az útfelületről.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is on</source>
            <translation>rajta van:</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>is {away:.2f} m from</source>
            <translation>{away:.2f} m-re van ettől:</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{layer} (feature {id})</source>
            <translation>{layer} ({id}. elem)</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{leave} of {legs} legs leave the road surface.</source>
            <translation>{legs} szakaszból {leave} letér az útfelületről.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{off} of {points} points are not on a road surface.</source>
            <translation>{points} pontból {off} nincs útfelületen.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{place} is not on a road surface.</source>
            <translation>{place} nincs útfelületen.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} enters the keepout {name}. Choose a place or way outside it.</source>
            <translation>{spot} a(z) {name} tiltott területre ér. Válasszon helyet vagy utat rajta kívül.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/keepout_checks.py" />
            <source>{spot} {where} {name}. Choose a place or way beside it.</source>
            <translation>{spot} {where} {name}. Válasszon helyet vagy utat mellette.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}.</source>
            <translation>A(z) {link} kapcsolat nem működik: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link} is down: {reason}. Nothing reaches {robots}.</source>
            <translation>A(z) {link} kapcsolat nem működik: {reason}. Semmi sem éri el ezeket: {robots}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>Link {link}: {reason}.</source>
            <translation>{link} kapcsolat: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The database account of robot {robot} is locked until {time}: its program kept all others waiting. Nothing but a stop reaches it: Abort unlocks the account. Have the program mended.</source>
            <translation>A(z) {robot} robot adatbázisfiókja {time}-ig zárolva van: programja mindenki mást megvárakoztatott. A leállításon kívül semmi sem éri el: a megszakítás feloldja a fiókot. Javíttassa meg a programot.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>The program of robot {robot} keeps all others waiting at the database, and its account cannot be locked. Have an administrator run: robot-bridge database upgrade</source>
            <translation>A(z) {robot} robot programja minden mást megvárakoztat az adatbázisnál, és a fiókja nem zárolható. Futtassa egy rendszergazda: robot-bridge database upgrade</translation>
        </message>
        <message>
            <location filename="../../plugin/control/messages.py" />
            <source>{names} and {count} more</source>
            <translation>{names} és még {count}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/pending_command.py" />
            <source>%n cones for {robot}</source>
            <translation>
                <numerusform>%n bója ennek: {robot}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>, theta {degrees:.0f}°</source>
            <translation>, theta {degrees:.0f}°</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; along the roads {note}</source>
            <translation>; az utak mentén {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; straight</source>
            <translation>; egyenesen</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>; the way there is being found</source>
            <translation>; az oda vezető út keresése folyik</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A part of this route follows the roads, and the way back may be another: it is not turned round. Draw it from the other end with Route on roads.</source>
            <translation>Az útvonal egy része az utakat követi, és visszafelé más lehet: nem lesz megfordítva. Rajzolja a másik végéről az Útvonal utakon eszközzel.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>A start position is no task: Send tells the robot at once.</source>
            <translation>A kiinduló helyzet nem feladat: a Küldés azonnal közli a robottal.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>And {more} more.</source>
            <translation>És még {more}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Cone for {robot} at {place}</source>
            <translation>Bója ennek: {robot}, itt: {place}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Route for {robot}: {points} points, {length:.1f} m{along_roads}</source>
            <translation>Útvonal ennek: {robot}: {points} pont, {length:.1f} m{along_roads}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>Start position of {robot} at {place}{turned}</source>
            <translation>{robot} kiinduló helyzete: {place}{turned}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>This part of the route follows the roads and is not changed by hand. Take it back with Backspace, or draw this part with Draw route.</source>
            <translation>Az útvonalnak ez a része az utakat követi, és kézzel nem módosítható. Vegye vissza Backspace-szel, vagy rajzolja ezt a részt az Útvonal rajzolása eszközzel.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>a route needs at least two points: click the next one</source>
            <translation>egy útvonalhoz legalább két pont kell: kattintson a következőre</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>it has not been checked to its end</source>
            <translation>az ellenőrzése még nem fejeződött be</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>the way there is not known yet</source>
            <translation>az oda vezető út még nem ismert</translation>
        </message>
        <message>
            <location filename="../../plugin/control/pending_command.py" />
            <source>{x:.2f}, {y:.2f} m</source>
            <translation>{x:.2f}, {y:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>ABORT ALL</source>
            <translation>MIND MEGSZAKÍTÁSA</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Clear emergency stop</source>
            <translation>Vészleállítás feloldása</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Closing the road at {x:.1f}, {y:.1f} m</source>
            <translation>Út lezárása itt: {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP</source>
            <translation>VÉSZLEÁLLÍTÁS</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use the robots' own emergency stops now.</source>
            <translation>A VÉSZLEÁLLÍTÁS MÉG NINCS elküldve: a kapcsolat megszakadt. Elmegy, amint visszatér; most használja a robotok saját vészleállítóit.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>Opening the road</source>
            <translation>Út megnyitása</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>The Abort is NOT sent yet: the link is down. It is sent if that is back within {seconds:g} s; use the robots' own emergency stops now.</source>
            <translation>A megszakítás MÉG NINCS elküldve: a kapcsolat megszakadt. Elmegy, ha {seconds:g} s-on belül visszatér; most használja a robotok saját vészleállítóit.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>the desk is not connected to a gateway. Connect first; to stop a robot now use the robot's own emergency stop.</source>
            <translation>a kezelőpult nincs átjáróhoz kapcsolva. Előbb kapcsolódjon; robotot most a saját vészleállítójával állíthat meg.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>this window, or the computer, stood still for {seconds:.0f} s, and what was clicked meanwhile may be old. Look at the robots, then ask again.</source>
            <translation>ez az ablak vagy a számítógép {seconds:.0f} s-ig állt, és amire közben kattintottak, régi lehet. Nézze meg a robotokat, majd kérje újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} was not sent: {fault}</source>
            <translation>{draft}: nem lett elküldve: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{draft} were not sent: several targets are driven to one after the other. Press Add to queue.</source>
            <translation>{draft}: nem lett elküldve: több célhoz egymás után kell menni. Nyomja meg a Várólistára gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{robot} gives way to {other}</source>
            <translation>{robot} elsőbbséget ad ennek: {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words} was NOT sent: {error}</source>
            <translation>{words}: NEM lett elküldve: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: done</source>
            <translation>{words}: kész</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: sent to %n robots</source>
            <translation>
                <numerusform>{words}: elküldve %n robotnak</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s, unless robots are asked to stop meanwhile; it is never done twice.</source>
            <translation>{words}: az átjáró {seconds:g} s óta nem válaszolt, így lehet, hogy nem érkezett meg. Megismétlődik, ha a kapcsolat {limit:g} s-on belül visszatér, hacsak közben a robotok megállítását nem kérik; kétszer sosem hajtódik végre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated if the link is back within {limit:g} s; it is never done twice.</source>
            <translation>{words}: az átjáró {seconds:g} s óta nem válaszolt, így lehet, hogy nem érkezett meg. Megismétlődik, ha a kapcsolat {limit:g} s-on belül visszatér; kétszer sosem hajtódik végre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/request_tracker.py" />
            <source>{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated when the link is back; it is never done twice.</source>
            <translation>{words}: az átjáró {seconds:g} s óta nem válaszolt, így lehet, hogy nem érkezett meg. Ha a kapcsolat helyreáll, megismétlődik; kétszer sosem hajtódik végre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route does not go there. Click there again.</source>
            <translation>Az átjáró {seconds:g} s óta nem válaszolt, melyik út vezet oda, ahová kattintott, ezért az útvonal nem megy oda. Kattintson oda újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>corners tighter than the robot turns: {tight}</source>
            <translation>a robot fordulásánál élesebb sarkok: {tight}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>off the roads of other robots</source>
            <translation>más robotok útjait elkerülve</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>only on {surfaces}</source>
            <translation>csak ezeken: {surfaces}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>roads at least {metres:g} m wide</source>
            <translation>legalább {metres:g} m széles utakon</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>surface not known</source>
            <translation>ismeretlen felület</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the fastest way</source>
            <translation>a leggyorsabb útvonal</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>the gateway's answer holds no way; it may be older than this plugin</source>
            <translation>az átjáró válaszában nincs út; lehet, hogy régebbi ennél a modulnál</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{metres:.0f} m {surface}</source>
            <translation>{metres:.0f} m {surface}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{metres:.1f} m</source>
            <translation>{metres:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{minutes} min {seconds} s</source>
            <translation>{minutes} perc {seconds} s</translation>
        </message>
        <message>
            <location filename="../../plugin/control/route_queries.py" />
            <source>{seconds} s</source>
            <translation>{seconds} s</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>There is nothing to send. Select a robot, then set a cone target or draw a route on the map.</source>
            <translation>Nincs mit küldeni. Jelöljön ki robotot, majd tegyen bójacélt vagy rajzoljon útvonalat a térképre.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent, since only now this is known: {warnings} Ask for it again to send it all the same.</source>
            <translation>{in_words}: nem lett elküldve, mert csak most derült ki: {warnings} Kérje újra, ha mégis el akarja küldeni.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: robots were told to stop before it had been checked.</source>
            <translation>{in_words}: nem lett elküldve, mert a robotok az ellenőrzés vége előtt megállási utasítást kaptak.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: the draft was changed before it had been checked. Send it anew.</source>
            <translation>{in_words}: nem lett elküldve, mert a vázlat az ellenőrzés vége előtt megváltozott. Küldje el újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {error}</source>
            <translation>{in_words} nem lett elküldve: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/control/sending.py" />
            <source>{in_words} was not sent: {robot} has moved since its way was found. It is found again from where the robot is now; send it when it is drawn.</source>
            <translation>{in_words} nem lett elküldve: {robot} elmozdult, mióta az útja megvan. Az út újra megkeresése onnan történik, ahol a robot most van; küldje el, amikor kirajzolódott.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>It is not known where {robot} is, so nobody has looked at the way that it drives.</source>
            <translation>Nem tudni, hol van {robot}, ezért senki sem nézte meg, milyen úton megy.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>No way along the roads leads there: {why}.</source>
            <translation>Oda nem vezet út az utakon: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>The gateway does not answer which way leads there. Set the target again when the link is there.</source>
            <translation>Az átjáró nem válaszol, hogy melyik út vezet oda. Ha a kapcsolat helyreállt, tűzze ki újra a célt.</translation>
        </message>
        <message>
            <location filename="../../plugin/control/validation.py" />
            <source>{robot} has not declared that it asks for its path or takes cones with one: sent now it drives straight. Add to queue, with a route around what is in its way, where that is not wanted.</source>
            <translation>{robot} nem jelezte, hogy elkéri az útját, vagy úttal együtt is elfogad bóját: most elküldve egyenesen megy. Ahol ez nem kívánatos, adja a sorhoz olyan útvonallal, amely kikerüli, ami az útjában van.</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function distance_to_robot&lt;/h3&gt; &lt;p&gt;Returns how far a robot is from a feature or a geometry, in metres of the site.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional; without it, that of the feature that is looked at&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the geometry, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; true of features near the robot&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;The distance is measured in the plane of the site's CRS; in a polygon it is 0. NULL stands for a robot whose place is not known, and while this QGIS is connected to no gateway. Places are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;distance_to_robot függvény&lt;/h3&gt; &lt;p&gt;Visszaadja, milyen messze van egy robot egy elemtől vagy geometriától, a telephely métereiben.&lt;/p&gt; &lt;h4&gt;Szintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;distance_to_robot(robot, [geometry], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentumok&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;a neve, ahogy a Flotta panelen áll&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;geometry&lt;/i&gt;&lt;/td&gt;&lt;td&gt;nem kötelező; nélküle a vizsgált elemé&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;nem kötelező, a geometria vetülete, például 'EPSG:4326'; nélküle azé a rétegé, amelynek elemét vizsgáljuk, különben a projekté&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Példák&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1')&lt;/code&gt; &amp;rarr; 12.3&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')&lt;/code&gt; &amp;rarr; 104.6&lt;/li&gt; &lt;li&gt;&lt;code&gt;distance_to_robot('r1') &amp;lt; 5&lt;/code&gt; &amp;rarr; igaz a robothoz közeli elemekre&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Megjegyzések&lt;/h4&gt; &lt;p&gt;A távolság a telephely vetületének síkjában értendő; poligonon belül 0. NULL, ha a robot helye nem ismert, és amíg ez a QGIS egy átjáróhoz sem kapcsolódik. A helyek legfeljebb fél másodpercesek; egy réteg akkor mutatja őket, amikor kirajzolódik.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function road_surface&lt;/h3&gt; &lt;p&gt;Returns the class of the road surface at a place, such as 'asphalt', or NULL where there is none.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;the place; x is the easting or the longitude, whatever the CRS&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the name or id of a layer of areas; without it, all layers of the project with the role road surface&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;optional, the CRS of the place, such as 'EPSG:4326'; without it, that of the layer whose feature is looked at, else that of the project&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; true off the road&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;A place on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger.&lt;/p&gt;</source>
            <translation>&lt;h3&gt;road_surface függvény&lt;/h3&gt; &lt;p&gt;Visszaadja egy hely útfelületének osztályát, például 'asphalt', vagy NULL, ahol nincs.&lt;/p&gt; &lt;h4&gt;Szintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;road_surface(x, y, [layer], [crs])&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentumok&lt;/h4&gt; &lt;table&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;x, y&lt;/i&gt;&lt;/td&gt;&lt;td&gt;a hely; x a keleti koordináta vagy a hosszúság, bármi is a vetület&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;layer&lt;/i&gt;&lt;/td&gt;&lt;td&gt;nem kötelező, egy területréteg neve vagy azonosítója; nélküle a projekt minden útfelület szerepű rétege&lt;/td&gt;&lt;/tr&gt; &lt;tr&gt;&lt;td&gt;&lt;i&gt;crs&lt;/i&gt;&lt;/td&gt;&lt;td&gt;nem kötelező, a hely vetülete, például 'EPSG:4326'; nélküle azé a rétegé, amelynek elemét vizsgáljuk, különben a projekté&lt;/td&gt;&lt;/tr&gt; &lt;/table&gt; &lt;h4&gt;Példák&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y)&lt;/code&gt; &amp;rarr; 'asphalt'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface(16.8438, 46.8804, crs:='EPSG:4326')&lt;/code&gt; &amp;rarr; 'slippery'&lt;/li&gt; &lt;li&gt;&lt;code&gt;road_surface($x, $y, 'Road surfaces') IS NULL&lt;/code&gt; &amp;rarr; igaz az úton kívül&lt;/li&gt; &lt;/ul&gt; &lt;h4&gt;Megjegyzések&lt;/h4&gt; &lt;p&gt;A peremen lévő hely a felületen van. Ahol felületek fedik egymást, a rajzolt előbbre való a generáltnál, azután a kisebb a nagyobbnál.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_age&lt;/h3&gt; &lt;p&gt;Returns the seconds since a robot's last message, by this computer's clock.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; true once it has been silent for more than 10 seconds&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;robot_age függvény&lt;/h3&gt; &lt;p&gt;Visszaadja, hány másodperce jött egy robot utolsó üzenete, e számítógép órája szerint.&lt;/p&gt; &lt;h4&gt;Szintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_age(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentumok&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;a neve, ahogy a Flotta panelen áll&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Példák&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_age('r1')&lt;/code&gt; &amp;rarr; 0.4&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_age('r1') &amp;gt; 10&lt;/code&gt; &amp;rarr; igaz, ha több mint 10 másodperce hallgat&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_battery&lt;/h3&gt; &lt;p&gt;Returns how full a robot's battery is, 0 to 1.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;robot_battery függvény&lt;/h3&gt; &lt;p&gt;Visszaadja, mennyire van feltöltve egy robot akkumulátora, 0-tól 1-ig.&lt;/p&gt; &lt;h4&gt;Szintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_battery(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentumok&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;a neve, ahogy a Flotta panelen áll&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Példák&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_battery('r1')&lt;/code&gt; &amp;rarr; 0.82&lt;/li&gt; &lt;li&gt;&lt;code&gt;round(100 * robot_battery('r1')) || ' %'&lt;/code&gt; &amp;rarr; '82 %'&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h3&gt;function robot_state&lt;/h3&gt; &lt;p&gt;Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or 'offline'.&lt;/p&gt; &lt;h4&gt;Syntax&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Arguments&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;its name, as in the Fleet panel&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Examples&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; true of robots that are silent&lt;/li&gt; &lt;/ul&gt;</source>
            <translation>&lt;h3&gt;robot_state függvény&lt;/h3&gt; &lt;p&gt;Visszaadja, mennyire lehet bízni abban, amit egy robotról tudunk: 'fresh' (friss), 'stale' (elavult), 'lost' (elveszett) vagy 'offline'.&lt;/p&gt; &lt;h4&gt;Szintaxis&lt;/h4&gt; &lt;p&gt;&lt;code&gt;robot_state(robot)&lt;/code&gt;&lt;/p&gt; &lt;h4&gt;Argumentumok&lt;/h4&gt; &lt;table&gt;&lt;tr&gt;&lt;td&gt;&lt;i&gt;robot&lt;/i&gt;&lt;/td&gt;&lt;td&gt;a neve, ahogy a Flotta panelen áll&lt;/td&gt;&lt;/tr&gt;&lt;/table&gt; &lt;h4&gt;Példák&lt;/h4&gt; &lt;ul&gt; &lt;li&gt;&lt;code&gt;robot_state('r1')&lt;/code&gt; &amp;rarr; 'fresh'&lt;/li&gt; &lt;li&gt;&lt;code&gt;robot_state("robot") IN ('stale', 'lost')&lt;/code&gt; &amp;rarr; igaz a hallgató robotokra&lt;/li&gt; &lt;/ul&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;h4&gt;Notes&lt;/h4&gt; &lt;p&gt;NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. What is not known of a robot is NULL as well. Values are at most half a second old; a layer shows them when it is drawn.&lt;/p&gt;</source>
            <translation>&lt;h4&gt;Megjegyzések&lt;/h4&gt; &lt;p&gt;NULL, ha az átjáró nem beszélt a robotról, és amíg ez a QGIS egyhez sem kapcsolódik. NULL az is, ami egy robotról nem ismert. Az értékek legfeljebb fél másodpercesek; egy réteg akkor mutatja őket, amikor kirajzolódik.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>&lt;p&gt;Of more than 5 000 robots QGIS is told of those on the map. Another one is asked for when an expression names it, and for a minute from then on, up to 200 of them: about a second later it has its value, NULL until then.&lt;/p&gt;</source>
            <translation>&lt;p&gt;5 000-nél több robot közül a QGIS azokról értesül, amelyek a térképen vannak. Egy másikat akkor kér le, amikor egy kifejezés megnevezi, és onnantól egy percig, legfeljebb 200-at: körülbelül egy másodperccel később van értéke, addig NULL.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>Fleet</source>
            <translation>Flotta</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>crs {given!r} is no CRS that QGIS knows; write a code such as 'EPSG:32633'</source>
            <translation>{given!r} nem olyan vetület, amelyet a QGIS ismer; írjon egy kódot, például 'EPSG:32633'</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no layer of the project has the role {role}; set it in Plugins &gt; Fleet Supervisor &gt; Layer roles, or name a layer as the third argument</source>
            <translation>a projekt egyik rétegének sincs ilyen szerepe: {role}; állítsa be itt: Modulok &gt; Fleet Supervisor &gt; Rétegszerepek, vagy nevezzen meg egy réteget harmadik argumentumként</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>no vector layer of the project has the name or id {layer!r}</source>
            <translation>a projektben nincs ilyen nevű vagy azonosítójú vektorréteg: {layer!r}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: the geometry has no place in {crs}</source>
            <translation>{function}: a geometriának nincs helye itt: {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: x is {x!r} and y is {y!r}; give two numbers</source>
            <translation>{function}: x értéke {x!r}, y értéke {y!r}; adjon meg két számot</translation>
        </message>
        <message>
            <location filename="../../plugin/expressions.py" />
            <source>{function}: {geometry!r} is no geometry; give one, or a feature that has one</source>
            <translation>{function}: {geometry!r} nem geometria; adjon meg egyet, vagy olyan elemet, amelynek van</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>abort</source>
            <translation>megszakítás</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>cone at {x}, {y}</source>
            <translation>bója itt: {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>done</source>
            <translation>kész</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>route of {number} points</source>
            <translation>{number} pontos útvonal</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/command_cache.py" />
            <source>target at {x}, {y}</source>
            <translation>cél itt: {x}, {y}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>A stop would wait for the rest of a large request on the slow line to {url}: the link is opened again, and the stop sent first.</source>
            <translation>Egy megállításnak meg kellene várnia egy nagy kérés maradékát a lassú vonalon ide: {url}. A kapcsolat újra megnyílik, és a megállítás megy el először.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The CA file {file} has not answered for {seconds:g} s, so there is no link to {url} yet: the drive that it is on may be away. The desk waits for it. If it stays away, press Disconnect and choose a copy of the file on this computer.</source>
            <translation>A(z) {file} CA-fájl {seconds:g} másodperce nem válaszol, ezért még nincs kapcsolat ezzel: {url}. Lehet, hogy a meghajtó, amelyen van, nem érhető el. A kezelőpult vár rá. Ha nem jön vissza, nyomja meg a Bontás gombot, és válassza a fájl másolatát ezen a számítógépen.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The connection stopped on an internal fault ({name}: {error}). Press Connect to try again and report this text.</source>
            <translation>A kapcsolat belső hiba miatt leállt ({name}: {error}). Nyomja meg a Kapcsolódás gombot az újrapróbáláshoz, és jelentse ezt a szöveget.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>The gateway at {url} closed the link. It is tried again.</source>
            <translation>A(z) {url} átjáró bontotta a kapcsolatot. Újrapróbálkozás folyik.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>This computer slept, or did nothing, for {seconds:.0f} s: what waits for it is old. The link is opened anew.</source>
            <translation>Ez a számítógép {seconds:.0f} másodpercig aludt vagy állt: ami közben várt rá, az elavult. A kapcsolat újra megnyílik.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>What answers at {url} opens a WebSocket but did not answer the desk's greeting within {answer_within:g} s. Check that the URL leads to a Fleet Supervisor gateway.</source>
            <translation>Ami a(z) {url} címen válaszol, nyit WebSocketet, de {answer_within:g} s alatt nem felelt a kezelőpult üdvözlésére. Ellenőrizze, hogy az URL Fleet Supervisor-átjáróra mutat-e.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} did not answer</source>
            <translation>itt: {gateway}; {given} nem válaszolt</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection.py" />
            <source>at {gateway}; {given} refuses this desk</source>
            <translation>itt: {gateway}; {given} elutasítja ezt a kezelőpultot</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>No secure link to {place}: {reason}. If the gateway has no TLS, write ws:// instead of wss://.</source>
            <translation>Nincs biztonságos kapcsolat ezzel: {place}: {reason}. Ha az átjárónak nincs TLS-e, írjon wss:// helyett ws://-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct the URL.</source>
            <translation>Semmi sem figyel itt: {place}. Indítsa el az átjárót (robot-bridge serve --site ...), vagy javítsa ki az URL-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Over {url} everybody on the way could read the token. Write wss:// instead of ws://; a gateway that other computers can reach has TLS.</source>
            <translation>A(z) {url} címen útközben bárki elolvashatná a tokent. Írjon ws:// helyett wss://-t; a más gépekről elérhető átjárónak van TLS-e.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The CA file {file} cannot be used: {reason}. Choose the ca.pem that whoever runs the site gave you.</source>
            <translation>A(z) {file} CA-fájl nem használható: {reason}. Válassza azt a ca.pem fájlt, amelyet a telephely üzemeltetője adott.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} cannot be trusted: {reason}.</source>
            <translation>{place} tanúsítványában nem lehet megbízni: {reason}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge tls renew'; if it was renewed, check this computer's clock.</source>
            <translation>{place} tanúsítványa lejárt. A telephely üzemeltetője a 'robot-bridge tls renew' paranccsal megújítja; ha már megújították, ellenőrizze ennek a számítógépnek az óráját.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} holds only later: check this computer's clock.</source>
            <translation>{place} tanúsítványa csak később lesz érvényes: ellenőrizze ennek a számítógépnek az óráját.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is for another name: {reason} Use the name that the gateway's certificate was made for, or have one made for this name.</source>
            <translation>{place} tanúsítványa más névre szól: {reason} Használja azt a nevet, amelyre az átjáró tanúsítványa készült, vagy készíttessen egyet erre a névre.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The certificate of {place} is from an authority that this desk does not trust. Choose the site's ca.pem as CA file under Access; whoever runs the site has it.</source>
            <translation>{place} tanúsítványa olyan kiállítótól van, amelyben ez a kezelőpult nem bízik. Válassza a telephely ca.pem fájlját CA-fájlnak a Hozzáférés alatt; a telephely üzemeltetőjénél van.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} closed the link (code {code}{why}). It is tried again by itself.</source>
            <translation>A(z) {place} átjáró bontotta a kapcsolatot (kód: {code}{why}). Magától újrapróbálkozik.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and enter it under Access.</source>
            <translation>A(z) {place} átjáró véget vetett a kapcsolatnak{why}. Kérjen új tokent a telephely üzemeltetőjétől, és adja meg a Hozzáférés alatt.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway at {place} ended your session{why}. Connect brings it back.</source>
            <translation>A(z) {place} átjáró véget vetett a munkamenetének{why}. A Kapcsolódás visszahozza.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL is empty. {example}</source>
            <translation>Az átjáró URL-je üres. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} begins with {scheme}; a gateway is reached over ws:// (or wss:// with TLS). {example}</source>
            <translation>Az átjáró URL-je, {url}, így kezdődik: {scheme}; az átjáró ws:// (vagy TLS-sel wss://) útján érhető el. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be read: {error}. {example}</source>
            <translation>Az átjáró URL-je, {url}, nem olvasható: {error}. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} cannot be used. Write it like {default_url}.</source>
            <translation>Az átjáró URL-je, {url}, nem használható. Írja így: {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} has port 0, where nothing can listen. {example}</source>
            <translation>Az átjáró URL-jében, {url}, 0 a port, ahol semmi sem figyelhet. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The gateway's URL {url} names no host. {example}</source>
            <translation>Az átjáró URL-je, {url}, nem nevez meg gépet. {example}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The host of {place} is not known to this network. Correct the URL.</source>
            <translation>{place} gépét ez a hálózat nem ismeri. Javítsa ki az URL-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The link to the gateway at {place} broke off. It is tried again by itself; if it does not come back, check the gateway and the network.</source>
            <translation>A kapcsolat a(z) {place} átjáróval megszakadt. Magától újrapróbálkozik; ha nem tér vissza, ellenőrizze az átjárót és a hálózatot.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>The token cannot be right: it is one word. Paste it again, whole and alone.</source>
            <translation>A token nem lehet jó: az egyetlen szó. Illessze be újra, egészben és magában.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, as in {default_url}; or another program answers there.</source>
            <translation>A(z) {url} címen nincs kezelőpult (HTTP 404). Az átjáróé a /desk útvonalon van, mint itt: {default_url}; vagy más program válaszol ott.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {place} does not speak WebSocket. Check host and port, and ws:// or wss://: a gateway prints its URL when it starts.</source>
            <translation>Ami itt válaszol: {place}, nem beszél WebSocketet. Ellenőrizze a gépet és a portot, és hogy ws:// vagy wss:// kell-e: az átjáró induláskor kiírja az URL-jét.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>What answers at {url} sent something that is not the desk's protocol: {text} ({kind}: {error}). Check that the URL leads to a Fleet Supervisor gateway of this version.</source>
            <translation>Ami a(z) {url} címen válaszol, olyasmit küldött, ami nem a kezelőpult protokollja: {text} ({kind}: {error}). Ellenőrizze, hogy az URL ugyanilyen verziójú Fleet Supervisor-átjáróra mutat-e.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>Write it like {default_url}.</source>
            <translation>Írja így: {default_url}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>it wants a token.</source>
            <translation>tokent kér.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no reason given.</source>
            <translation>nem mondott okot.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>no scheme</source>
            <translation>nincs séma</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>operator</source>
            <translation>kezelő</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>supervisor</source>
            <translation>felügyelő</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>viewer</source>
            <translation>megfigyelő</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} broke off while the secure link was made. If the gateway has no TLS, write ws:// instead of wss://.</source>
            <translation>{place} megszakította a biztonságos kapcsolat felépítését. Ha az átjárónak nincs TLS-e, írjon wss:// helyett ws://-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} cannot be reached: {reason}. Check network and URL.</source>
            <translation>{place} nem érhető el: {reason}. Ellenőrizze a hálózatot és az URL-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{place} did not answer in time. Check that the gateway runs, and the network and firewall.</source>
            <translation>{place} nem válaszolt időben. Ellenőrizze, hogy fut-e az átjáró, valamint a hálózatot és a tűzfalat.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there and what its log says.</source>
            <translation>{url} HTTP {status} választ adott WebSocket nyitása helyett. Ellenőrizze, hogy ott átjáró fut-e, és mit mond a naplója.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} is where robots connect; operators connect to {desk}. Write that instead.</source>
            <translation>A(z) {url} címen a robotok kapcsolódnak; a kezelők ide: {desk}. Ezt írja helyette.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said}</source>
            <translation>{url} elutasítja ezt a kezelőpultot: {said}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} refuses this desk: {said} Enter the operator's token under Access.</source>
            <translation>{url} elutasítja ezt a kezelőpultot: {said} Adja meg a kezelő tokenjét a Hozzáférés alatt.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/connection_status.py" />
            <source>{url} takes no desk now: {said} It is tried again by itself.</source>
            <translation>{url} most nem fogad kezelőpultot: {said} Magától újrapróbálkozik.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>Another site is served now: {site}, no longer {before}. Open its project.</source>
            <translation>Most másik telephely van kiszolgálva: {site}, már nem {before}. Nyissa meg annak projektjét.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/fleet_state.py" />
            <source>The gateway has another database than before: its robots and commands are others, and those of before are not shown any more.</source>
            <translation>Az átjárónak más adatbázisa van, mint előbb: robotjai és parancsai mások, a korábbiak már nem látszanak.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>Another site, or another fleet, is served now than when this was asked for, and the same numbers are other places there: it was not sent to it. Look at the map, and ask for it again if it is still needed.</source>
            <translation>Már másik telephely vagy másik flotta van szolgáltatva, mint amikor ezt kérték, és ugyanazok a számok ott más helyek: oda nem lett elküldve. Nézze meg a térképet, és kérje újra, ha még szükség van rá.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>It was sent before on a link that was lost, and may have been done then: look before you ask again.</source>
            <translation>Egy megszakadt kapcsolaton már elküldték, és akkor végrehajtódhatott: nézze meg, mielőtt újra kéri.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>No operator can connect at {url}: what answers there knows no desk, as the address of robots does not. A gateway's desk has the path /desk, as in {default_url}. Correct the URL, then press Connect.</source>
            <translation>A(z) {url} címen kezelő nem kapcsolódhat: ami ott válaszol, nem ismer kezelőpultot, ahogy a robotok címe sem. Az átjáró kezelőpultjának útvonala /desk, mint itt: {default_url}. Javítsa az URL-t, majd nyomja meg a Kapcsolódás gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} refused a message: {error}</source>
            <translation>A(z) {url} átjáró visszautasított egy üzenetet: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} sends no positions: {error}</source>
            <translation>A(z) {url} átjáró nem küld helyzeteket: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} serves another fleet than the gateway that named it. Connect to it yourself if that is what you want.</source>
            <translation>A(z) {url} átjáró más flottát szolgál ki, mint az az átjáró, amelyik megnevezte. Csatlakozzon hozzá közvetlenül, ha ezt szeretné.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} speaks protocol {theirs}, this plugin protocol {ours}. Update whichever of the two is older, then press Connect.</source>
            <translation>A(z) {url} átjáró a(z) {theirs}. protokollt beszéli, ez a modul a(z) {ours}. protokollt. Frissítse kettejük közül a régebbit, majd nyomja meg a Kapcsolódás gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The gateway at {url} turned the desk away: {error}</source>
            <translation>A(z) {url} átjáró elutasította a kezelőpultot: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was closed before the gateway answered: whether it arrived is not known. Connect again and look in the command log.</source>
            <translation>A kapcsolat lezárult, mielőtt az átjáró válaszolt volna: hogy megérkezett-e, nem ismert. Kapcsolódjon újra, és nézze meg a parancsnaplót.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and it was not sent again: robots were asked to stop after it. If it had arrived before, the command log shows it, and the stop ends it.</source>
            <translation>A kapcsolat megszakadt, mielőtt az átjáró válaszolt volna, és nem lett újra elküldve: utána a robotok megállítását kérték. Ha mégis megérkezett, a parancsnaplóban látszik, és a megállítás véget vet neki.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: a robot shall not drive off on an old order. Look in the command log and send it again if it is not there.</source>
            <translation>A kapcsolat megszakadt, mielőtt az átjáró válaszolt volna, és {age:.0f} s múlva már nem lett megismételve: robot ne induljon el régi parancsra. Nézze meg a parancsnaplót, és küldje újra, ha nincs ott.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>The link was lost before the gateway answered, and {age:.0f} s later it was not repeated: the robot may be doing something else by now. Look at the robot, and ask again if it shall still stop.</source>
            <translation>A kapcsolat megszakadt, mielőtt az átjáró válaszolt volna, és {age:.0f} s múlva már nem lett megismételve: a robot azóta mást csinálhat. Nézze meg a robotot, és kérje újra, ha még mindig meg kell állnia.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/protocol.py" />
            <source>the gateway takes no message as large as this one of {size} kB. Ask for less at once, or have largest_message_bytes raised in the site's settings.</source>
            <translation>az átjáró nem fogad ekkora, {size} kB-os üzenetet. Kérjen egyszerre kevesebbet, vagy emeltesse meg a largest_message_bytes értékét a telephely beállításaiban.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: the gateway tells nothing of them. It may be older than this plugin.</source>
            <translation>A tiltott területeket és akadályokat senki nem figyeli: az átjáró semmit sem mond róluk. Lehet, hogy régebbi ennél a modulnál.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Keepouts and obstacles are not watched: {why}.</source>
            <translation>A tiltott területeket és akadályokat senki nem figyeli: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>Not judged by keepouts and obstacles, since it is not known where they are: {names}.</source>
            <translation>Tiltott területek és akadályok szerint nem ítélhető meg, mert nem tudni, hol van: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>People near robots are not watched: {why}.</source>
            <translation>A robotok közelében lévő embereket nem figyeli senki: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no keepouts.</source>
            <translation>A közzétett telephelyen nincs tiltott terület.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>The published site has no obstacles, so nobody is told to be at one.</source>
            <translation>A közzétett telephelyen nincs akadály, így akadálynál senkit sem jelez.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more</source>
            <translation>további {more}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/report_caches.py" />
            <source>{more} more are in keepouts or at obstacles and not listed.</source>
            <translation>További {more} van tiltott területen vagy akadálynál, felsorolás nélkül.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>%n tasks</source>
            <translation>
                <numerusform>%n feladat</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, a path of {path_points} points</source>
            <translation>, {path_points} pontos pálya</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>, {deviation:.2f} m off</source>
            <translation>, {deviation:.2f} m eltérés</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>. The robot is {state}: it is sent nothing until it is heard again</source>
            <translation>. A robot állapota {state}: semmit sem kap, amíg újra nem hallani róla</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>Last: {task} {state} {time}{off}{why}</source>
            <translation>Utolsó: {task} {state} {time}{off}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.</source>
            <translation>Ez a kezelőpult {all} robotból {known} robotról kap hírt: a térképen láthatókról, a kijelöltekről és a riasztásban lévőkről.</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>aborted</source>
            <translation>megszakítva</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>acknowledged</source>
            <translation>nyugtázva</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>by {by}</source>
            <translation>{by}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>collect cone</source>
            <translation>bója begyűjtése</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>crossing</source>
            <translation>keresztezés</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>delivered</source>
            <translation>kézbesítve</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>drive</source>
            <translation>menet</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>expired</source>
            <translation>lejárt</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>failed</source>
            <translation>sikertelen</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>following</source>
            <translation>követés</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>fresh</source>
            <translation>friss</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>head-on</source>
            <translation>szemből</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>lost</source>
            <translation>elveszett</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>nothing to do</source>
            <translation>nincs dolga</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>now</source>
            <translation>most</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>offline</source>
            <translation>offline</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>place cone</source>
            <translation>bója kihelyezése</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>queued</source>
            <translation>sorban</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>reached</source>
            <translation>elérve</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>removed</source>
            <translation>eltávolítva</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>running</source>
            <translation>fut</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>skipped</source>
            <translation>kihagyva</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>stale</source>
            <translation>elavult</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>standing</source>
            <translation>álló robot</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>superseded</source>
            <translation>felülírva</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>unsure</source>
            <translation>bizonytalan</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>waiting</source>
            <translation>vár</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{kind}{name} at {x:.2f}, {y:.2f}{way}</source>
            <translation>{kind}{name} itt: {x:.2f}, {y:.2f}{way}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{robot}: {count}, PAUSED{when}{why}</source>
            <translation>{robot}: {count}, SZÜNETEL{when}{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/gateway_client/state_words.py" />
            <source>{state}, may be elsewhere</source>
            <translation>{state}, lehet, hogy máshol van</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source># Help

{file} cannot be read: {strerror}. Install the plugin again.</source>
            <translation># Súgó

{file} nem olvasható: {strerror}. Telepítse újra a modult.</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor help</source>
            <translation>A Fleet Supervisor súgója</translation>
        </message>
        <message>
            <location filename="../../plugin/help.py" />
            <source>Fleet Supervisor: help</source>
            <translation>Fleet Supervisor: súgó</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source> (EPSG:326xx north, EPSG:327xx south of the equator)</source>
            <translation> (az Egyenlítőtől északra EPSG:326xx, délre EPSG:327xx)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The CRS {crs} cannot carry a site</source>
            <translation>A(z) {crs} vetület nem hordozhat telephelyet</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>The layers are in different CRSs ({names}), and nothing says which is the site's: give SITE_CRS, or set the project's CRS.</source>
            <translation>A rétegek vetülete különböző ({names}), és semmi nem mondja meg, melyik a telephelyé: adja meg a SITE_CRS-t, vagy állítsa be a projekt vetületét.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>without a name</source>
            <translation>név nélküli</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its coordinates are not metres on a plane. Choose a projected CRS such as the local UTM zone{suggestion}.</source>
            <translation>{named}: koordinátái nem síkbeli méterek. Válasszon vetített rendszert, például a helyi UTM-zónát{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its metres are not metres; 1 m on the ground is 1.56 m there at latitude 50°. Choose the local UTM zone, such as EPSG:32633 for 12°E to 18°E.</source>
            <translation>{named}: méterei nem méterek; 1 m a talajon ott 1.56 m az 50°-os szélességen. Válassza a helyi UTM-zónát, például EPSG:32633 a 12°K és 18°K között.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/crs.py" />
            <source>{named}: its unit is {unit}, and robots speak metres. Choose a CRS in metres such as the local UTM zone{suggestion}.</source>
            <translation>{named}: egysége {unit}, és a robotok métert használnak. Válasszon méteres vetületet, például a helyi UTM-zónát{suggestion}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source> at ({x:.2f} {y:.2f})</source>
            <translation> itt: ({x:.2f} {y:.2f})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/geometry.py" />
            <source>%n different points</source>
            <translation>
                <numerusform>%n különböző pont</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>courtyard {k} of part {number}{place} has {points} and encloses nothing; the courtyard is left out</source>
            <translation>a(z) {number}. rész {k}. udvarában{place} {points} van, és nem zár körül semmit; az udvar kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a coordinate that is no number, has no place in the site's CRS or lies beyond 100 000 km; it is left out</source>
            <translation>van olyan koordinátája, amely nem szám, nincs helye a telephely vetületében, vagy 100 000 km-en túl van; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>has a {kind}, which is no area or line; it is left out</source>
            <translation>van benne {kind}, ami se nem terület, se nem vonal; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>its corners span no surface that one can drive on; its normal is left out</source>
            <translation>a sarkai nem feszítenek ki járható felületet; a normálisa kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>line {number} has fewer than two different points; it is left out</source>
            <translation>a(z) {number}. vonalnak kettőnél kevesebb különböző pontja van; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>not valid</source>
            <translation>nem érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>riser {number} is bent; the straight line between its ends is used</source>
            <translation>a(z) {number}. lépcsőfok hajlott; a két vége közötti egyenes érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the outer ring of part {number}{place} has {points} and encloses nothing; the part is left out</source>
            <translation>a(z) {number}. rész külső gyűrűjében{place} {points} van, és nem zár körül semmit; a rész kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>the polygon is broken{place}: {what}</source>
            <translation>a poligon hibás{place}: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it cannot be repaired and is left out</source>
            <translation>{fault}; nem javítható, kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/geometry.py" />
            <source>{fault}; it was repaired</source>
            <translation>{fault}; ki lett javítva</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: it has no field {missing}, which the {what} expression {text!r} reads; the default is used for all its features</source>
            <translation>{layer} réteg: nincs {missing} mezője, amelyet a(z) {what} kifejezés ({text!r}) olvas; minden eleménél az alapérték érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>Layer {layer}: {note}</source>
            <translation>{layer} réteg: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} is not one: {error}. Correct it.</source>
            <translation>A(z) {what} kifejezés ({text!r}) a(z) {layer} rétegnél nem az: {error}. Javítsa ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>The {what} expression {text!r} for the layer {layer} reads the field {missing}, which the layer does not have. Correct it, or write attribute('...') for a field that some layers lack.</source>
            <translation>A(z) {what} kifejezés ({text!r}) a(z) {layer} rétegnél a(z) {missing} mezőt olvassa, amely a rétegnek nincs. Javítsa ki, vagy írja így: attribute('...'), ha a mező egyes rétegekből hiányzik.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>it is left out</source>
            <translation>kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its base {value!r} is not a number of metres; it is taken to stand on the ground</source>
            <translation>az alja {value!r}, ez nem méterszám; úgy vesszük, hogy a talajon áll</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its filter gives {value!r}, which is neither true nor false; it is left out</source>
            <translation>a szűrője ezt adja: {value!r}, ami se nem igaz, se nem hamis; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its label has letters that cannot be read: set the layer's encoding (Properties &gt; Source), or put a .cpg file beside its shapefile</source>
            <translation>a címkéjében olvashatatlan betűk vannak: állítsa be a réteg kódolását (Tulajdonságok &gt; Forrás), vagy tegyen .cpg fájlt a shapefile mellé</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its outdoor flag {value!r} is neither true nor false; true is used</source>
            <translation>a kültéri jelzője {value!r}, ami se nem igaz, se nem hamis; igaznak vesszük</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres above 0; the default is used</source>
            <translation>{what} értéke {value!r}, ez nem 0-nál több méter; az alapérték érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>its {what} {value!r} is not a number of metres of 0 or more; {otherwise}</source>
            <translation>{what} értéke {value!r}, ez nem 0 vagy több méter; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the default is used</source>
            <translation>az alapérték érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the estimate is used</source>
            <translation>a becslés érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_expressions.py" />
            <source>the {what} expression fails: {error}; {otherwise}</source>
            <translation>a(z) {what} kifejezés hibát ad: {error}; {otherwise}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, feature {id}: {note}</source>
            <translation>{layer} réteg, {id}. elem: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}: {note}</source>
            <translation>{layer} réteg, {features}: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}, {features}; of the first: {note}</source>
            <translation>{layer} réteg, {features}; az elsőé: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>Layer {layer}: warnings of more kinds about {features}</source>
            <translation>{layer} réteg: további fajta figyelmeztetések: {features}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be opened ({source}): repair its data source or leave it out.</source>
            <translation>A(z) {name} réteg nem nyitható meg ({source}): javítsa ki az adatforrását, vagy hagyja ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read any more: QGIS gets none of its features. Its file or database was moved, damaged or cut off since the project was opened. Bring it back, or repair the layer's data source, and open the project again.</source>
            <translation>A(z) {name} réteg már nem olvasható: a QGIS egyetlen elemét sem kapja meg. A fájlját vagy az adatbázisát a projekt megnyitása óta áthelyezték, megsérült vagy megszakadt a kapcsolata. Állítsa vissza, vagy javítsa ki a réteg adatforrását, és nyissa meg újra a projektet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} cannot be read to its end ({error}): its file is damaged, or was not copied whole. Replace it by a sound copy, or leave the layer out.</source>
            <translation>A(z) {name} réteg nem olvasható végig ({error}): a fájlja sérült, vagy nem lett teljesen átmásolva. Cserélje ép másolatra, vagy hagyja ki a réteget.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>The layer {name} holds {held}, and only lines and polygons are obstacles: leave it out, give it an extent first (for example with Buffer), or the role furniture.</source>
            <translation>A(z) {name} réteg tartalma: {held}, és csak vonalak és poligonok akadályok: hagyja ki, adjon neki előbb kiterjedést (például Övezettel), vagy a berendezés szerepet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>feature {shown}</source>
            <translation>{shown}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown}</source>
            <translation>{shown}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>features {shown} and {more} more</source>
            <translation>{shown}. elem és még {more}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>no geometry</source>
            <translation>nincs geometria</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/layer_source.py" />
            <source>points</source>
            <translation>pontok</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: %n heights are not known and estimated as {height:g} m ({features})</source>
            <translation>
                <numerusform>{name} réteg: %n magasság nem ismert, becslésük {height:g} m ({features})</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role is {role}, yet it is exported as obstacles</source>
            <translation>{name} réteg: a szerepe {role}, mégis akadályként exportálódik</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>Layer {name}: its role {role} wants {wanted}; other features are exported as plain obstacles ({features})</source>
            <translation>{name} réteg: {role} szerepéhez ez kell: {wanted}; a többi elem egyszerű akadályként exportálódik ({features})</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>cannot be transformed into the site's CRS ({error}); it is left out</source>
            <translation>nem számítható át a telephely vetületébe ({error}); kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>has no geometry; it is left out</source>
            <translation>nincs geometriája; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its rotation {value!r} is not a number of degrees; it is not turned</source>
            <translation>az elforgatása {value!r}, ez nem fokszám; nem forgatjuk el</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>its width {width:g} m is none of furniture; {used:g} is used</source>
            <translation>{width:g} m szélesség nem berendezésé; {used:g} érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>lines, one a riser</source>
            <translation>vonal, lépcsőfokonként egy</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>polygons</source>
            <translation>poligon</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/obstacle_layers.py" />
            <source>{error}; its width is used</source>
            <translation>{error}; a szélessége érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Another publication of {site} into database {database} has ended meanwhile: publish again.</source>
            <translation>Közben véget ért {site} egy másik közzététele ebbe az adatbázisba: {database}. Tegye közzé újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>QGIS has no PostgreSQL connection {name}; it has: {known}. Make it in the browser panel, PostgreSQL &gt; New Connection, or write the address of the database, such as postgresql://account@host/database.</source>
            <translation>A QGIS-ben nincs {name} nevű PostgreSQL-kapcsolat; ezek vannak: {known}. Hozza létre a böngésző panelen (PostgreSQL &gt; Új kapcsolat), vagy írja be az adatbázis címét, például postgresql://account@host/database.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>SITE_ID {site} is too long for a database: give one of at most {most} letters.</source>
            <translation>A SITE_ID ({site}) túl hosszú egy adatbázishoz: adjon meg legfeljebb {most} betűset.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Somebody has read or written {site} in database {database} for more than {seconds} s: wait until another publication has ended, close what shows its layers, and publish again.</source>
            <translation>Valaki {seconds} s-nál hosszabb ideje olvassa vagy írja ezt: {site} ({database} adatbázis). Várja meg, amíg egy másik közzététel véget ér, zárja be, ami a rétegeit mutatja, és tegye közzé újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>Something of yours is made of the views of {site} in database {database}, which stand for one version: {error}. Remove it, publish, and make it again.</source>
            <translation>Valami sajátja a(z) {site} telephely nézeteire épül a(z) {database} adatbázisban, amelyek most mások lesznek: {error}. Távolítsa el, tegye közzé a telephelyet, és hozza létre újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The PostGIS of database {database} does not know {crs}: choose a SITE_CRS that its table spatial_ref_sys has, or have an administrator add this one there.</source>
            <translation>A(z) {database} adatbázis PostGIS-e nem ismeri ezt: {crs}. Válasszon olyan SITE_CRS-t, amely megvan a spatial_ref_sys táblájában, vagy vetesse fel oda egy rendszergazdával.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The Python package psycopg2 is missing in this QGIS, which writes to PostgreSQL: {install}</source>
            <translation>Ebből a QGIS-ből hiányzik a psycopg2 Python-csomag, amely PostgreSQL-be ír: {install}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The account {account} may make no schemas in database {database}, and a site is published in some. Its owner runs: {command}</source>
            <translation>A(z) {account} fiók nem hozhat létre sémát a(z) {database} adatbázisban, márpedig a telephely sémákba kerül. A tulajdonosa ezt futtassa: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The connection to database {database} was lost at the last moment: {site} is published there, or is as it was. Publish again.</source>
            <translation>A kapcsolat az adatbázissal ({database}) az utolsó pillanatban megszakadt: {site} vagy megjelent ott, vagy olyan, amilyen volt. Tegye közzé újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database cannot be reached: {error}. Check that it runs, and the host, database, account and password of the connection.</source>
            <translation>Az adatbázis nem érhető el: {error}. Ellenőrizze, hogy fut-e, és a kapcsolat gépét, adatbázisát, fiókját és jelszavát.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The database {database} has no PostGIS. Install the package postgresql-15-postgis-3 (of your version) on the server, and as its administrator run in this database: create extension postgis</source>
            <translation>A(z) {database} adatbázisban nincs PostGIS. Telepítse a kiszolgálóra a postgresql-15-postgis-3 csomagot (a saját verziójához valót), és rendszergazdaként futtassa ebben az adatbázisban: create extension postgis</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The schema {schema} of database {database} is of another program, or of another version of this one (it says “{found}”): publish with that, or into another database.</source>
            <translation>A(z) {database} adatbázis {schema} sémája más programé, vagy e program más verziójáé (ez áll benne: „{found}”): azzal tegye közzé, vagy más adatbázisba.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The site cannot be published in database {database}: {error}. What was published there before is as it was.</source>
            <translation>A telephely nem tehető közzé ebben az adatbázisban: {database}: {error}. Ami korábban megjelent ott, olyan, amilyen volt.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>The sites in database {database} belong to the account {owner}, and not to {account}: publish as {owner}, or have an administrator run: {command}</source>
            <translation>A(z) {database} adatbázis telephelyei a(z) {owner} fiókéi, nem ezé: {account}. Tegye közzé mint {owner}, vagy futtassa egy rendszergazda: {command}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/postgis.py" />
            <source>install the distribution's package, such as python3-psycopg2.</source>
            <translation>telepítse a disztribúció csomagját, például ezt: python3-psycopg2.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Another publication into {folder} is under way, by {who}: wait until it has ended, or choose another folder. If it ended on another computer without a word, remove {file}.</source>
            <translation>Másik közzététel folyik ide: {folder} ({who}): várjon, amíg véget ér, vagy válasszon másik mappát. Ha másik számítógépen szó nélkül ért véget, törölje ezt: {file}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Keepouts</source>
            <translation>Tiltott területek</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Obstacles</source>
            <translation>Akadályok</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Publish the site again.</source>
            <translation>Tegye közzé újra a telephelyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road centrelines</source>
            <translation>Úttengelyek</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>Road surfaces</source>
            <translation>Útfelületek</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {file} is a file. Choose a folder: a new one, or the one that the site was published in before.</source>
            <translation>A telephely nem tehető közzé itt: {folder}: {file} egy fájl. Válasszon mappát: újat, vagy azt, amelyben a telephely korábban megjelent.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>The site cannot be published in {folder}: {reason}. Check the folder's rights and the free space.</source>
            <translation>A telephely nem tehető közzé itt: {folder}: {reason}. Ellenőrizze a mappa jogait és a szabad helyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>another process</source>
            <translation>másik folyamat</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>no file {lock_file} can be made in it</source>
            <translation>nem hozható létre benne {lock_file} fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>process {process} on {host}</source>
            <translation>{process} folyamat itt: {host}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} cannot be read: {error}</source>
            <translation>{file} nem olvasható: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} has no layer {layers} that can be read. {again}</source>
            <translation>{file} fájlban nincs olvasható {layers} réteg. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} is there and is no part of a published site: choose another folder, or say that it may be replaced (REPLACE=true).</source>
            <translation>{file} ott van, és nem része közzétett telephelynek: válasszon másik mappát, vagy mondja, hogy felülírható (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{file} names no site: it has no table [site] with a name. {again}</source>
            <translation>{file} nem nevez meg telephelyet: nincs benne [site] tábla névvel. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} has a {settings} and no {geopackage}. {again}</source>
            <translation>{folder}: van benne {settings}, de nincs {geopackage}. {again}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/publication.py" />
            <source>{folder} holds version {version} of another site, {other}: choose another folder for {site}, or say that the other site may be replaced (REPLACE=true).</source>
            <translation>{folder} egy másik telephely, {other} {version}. verzióját tartalmazza: válasszon másik mappát ennek: {site}, vagy mondja, hogy a másik telephely felülírható (REPLACE=true).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>GDAL does not say why</source>
            <translation>A GDAL nem mondja meg, miért</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>The Python bindings of GDAL (osgeo) are missing in this QGIS, which write site.gpkg: install the distribution's package, such as python3-gdal.</source>
            <translation>Ebből a QGIS-ből hiányoznak a GDAL Python-kötései (osgeo), amelyek a site.gpkg fájlt írják: telepítse a disztribúció csomagját, például python3-gdal.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/publishing/site_file.py" />
            <source>{file} cannot be written in {folder}: {error}. Check the folder's rights and the free space.</source>
            <translation>{file} nem írható ide: {folder}: {error}. Ellenőrizze a mappa jogait és a szabad helyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/reading.py" />
            <source>The layer {layer} has not answered for {seconds:g} s. Bring its server or drive back and try again.</source>
            <translation>A(z) {layer} réteg {seconds:g} másodperce nem válaszol. Tegye újra elérhetővé a kiszolgálóját vagy a meghajtóját, és próbálja újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>Layer {layer}: the width of {count} of its roads is not known and taken as {width:g} m (feature {first} is the first)</source>
            <translation>{layer} réteg: {count} útjának szélessége nem ismert, {width:g} m-nek vesszük (az első a(z) {first}. elem)</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a line, which is no area; it is left out</source>
            <translation>van benne vonal, ami nem terület; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>has a polygon, which is no centreline; it is left out</source>
            <translation>van benne poligon, ami nem úttengely; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its direction {value!r} is none of yes, -1 and no; it is taken as driven both ways</source>
            <translation>az iránya {value!r}: se nem yes, se nem -1, se nem no; mindkét irányban járhatónak vesszük</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its level {value!r} is no number; it is taken to be on the ground</source>
            <translation>a szintje {value!r}, ez nem szám; a talajon lévőnek vesszük</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>its speed {value!r} is no number above 0; the default is used</source>
            <translation>a sebessége {value!r}, ez nem 0-nál nagyobb szám; az alapérték érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>none of its fields direction, oneway, one_way and other_tags is there to tell one-way roads; all are taken as driven both ways</source>
            <translation>a direction, oneway, one_way és other_tags mezők egyike sincs meg, amely az egyirányú utakat megadná; mindegyik kétirányúnak számít</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_layers.py" />
            <source>whether it is closed, {value!r}, is neither true nor false; it is taken as closed</source>
            <translation>hogy le van-e zárva: {value!r}, ami se nem igaz, se nem hamis; lezártnak vesszük</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/road_surfaces.py" />
            <source>the road surfaces are still being read ({layers}): try again soon</source>
            <translation>az útfelületek beolvasása még tart ({layers}): próbálja újra hamarosan</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n keepouts</source>
            <translation>
                <numerusform>%n tiltott terület</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n layers refused</source>
            <translation>
                <numerusform>%n réteg elutasítva</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n obstacles</source>
            <translation>
                <numerusform>%n akadály</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n roads</source>
            <translation>
                <numerusform>%n út</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n segments</source>
            <translation>
                <numerusform>%n szakasz</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n surfaces</source>
            <translation>
                <numerusform>%n felület</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>%n warnings</source>
            <translation>
                <numerusform>%n figyelmeztetés</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>Preview of the site</source>
            <translation>A telephely előnézete</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>refused</source>
            <translation>elutasítva</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>{metres:g} m</source>
            <translation>{metres:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/preview.py" />
            <source>{obstacles} of {segments}</source>
            <translation>{obstacles}, {segments}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Comes to</source>
            <translation>Eredmény</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Estimate [m]</source>
            <translation>Becslés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres above the ground where it begins, as of an arch; empty: 0</source>
            <translation>Kifejezés arra, hány méterrel a talaj felett kezdődik, mint egy ív; üres: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for metres from the foot up; empty: the field height or height_m</source>
            <translation>Kifejezés az aljtól felfelé mért méterekre; üres: a height vagy height_m mező</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the degrees clockwise that the template is turned; empty: 0</source>
            <translation>Kifejezés arra, hány fokkal van a sablon elforgatva az óramutató járásával; üres: 0</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the height where it is not known, such as 3 * "levels"; marked as estimated</source>
            <translation>Kifejezés a magasságra, ahol nem ismert, például 3 * "levels"; becsültként jelölve</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the label, such as 'building,' || "name"; of a road its surface</source>
            <translation>Kifejezés a címkére, például 'building,' || "name"; útnál a felületére</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the metres across, of a road or of furniture that is points</source>
            <translation>Kifejezés az átmérőre méterben, útnál vagy pontként rajzolt berendezésnél</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for the shape that a point of furniture stands for: {shapes}, 'circle 0.6', 'square 1' or 'rectangle 2 0.5'; empty: an octagon of its width</source>
            <translation>Kifejezés arra az alakra, amelyet egy berendezéspont jelöl: {shapes}, 'circle 0.6', 'square 1' vagy 'rectangle 2 0.5'; üres: a szélességével rajzolt nyolcszög</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression for true or false; empty: true</source>
            <translation>Kifejezés igazra vagy hamisra; üres: igaz</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Expression that is true of the features that count, such as "amenity" = 'bench'; empty: all</source>
            <translation>Kifejezés, amely a számító elemekre igaz, például "amenity" = 'bench'; üres: mind</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Filter</source>
            <translation>Szűrő</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Foot [m]</source>
            <translation>Alja [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Height [m]</source>
            <translation>Magasság [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Label</source>
            <translation>Címke</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Layer</source>
            <translation>Réteg</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Layers of the project that can have a role</source>
            <translation>A projekt rétegei, amelyeknek szerepük lehet</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Outdoors</source>
            <translation>Szabadban</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Template</source>
            <translation>Sablon</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Turned [°]</source>
            <translation>Elforgatva [°]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What is published of the layer</source>
            <translation>Mi kerül közzétételre a rétegből</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>What the layer is to robots and operators</source>
            <translation>Mi a réteg a robotoknak és a kezelőknek</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>Width [m]</source>
            <translation>Szélesség [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>furniture</source>
            <translation>berendezés</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>keepout</source>
            <translation>tiltott terület</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>obstacle</source>
            <translation>akadály</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>orthophoto</source>
            <translation>ortofotó</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>ramp</source>
            <translation>rámpa</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>road centreline</source>
            <translation>úttengely</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>road surface</source>
            <translation>útfelület</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/role_table.py" />
            <source>stairs</source>
            <translation>lépcső</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Apply profile</source>
            <translation>Profil alkalmazása</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles</source>
            <translation>Rétegszerepek</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Layer roles…</source>
            <translation>Rétegszerepek…</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile</source>
            <translation>Térképprofil</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile ({kinds})</source>
            <translation>Térképprofil ({kinds})</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Map profile:</source>
            <translation>Térképprofil:</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Profile from file…</source>
            <translation>Profil fájlból…</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Reading %n layers …</source>
            <translation>
                <numerusform>%n réteg olvasása …</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>Say what each layer of the project is to robots</source>
            <translation>Megmondja, mi a projekt egyes rétege a robotoknak</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name} knows none of these layers. It looks for layers that are named, in their source or in the project: {sought}.</source>
            <translation>A(z) {name} e rétegek egyikét sem ismeri. Olyan rétegeket keres, amelyek neve a forrásukban vagy a projektben: {sought}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/layers/role_editor/roles_dialog.py" />
            <source>{name}: {known} of %n layers set up.</source>
            <translation>
                <numerusform>{name}: %n rétegből {known} beállítva.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} cannot be read: {error}.</source>
            <translation>A(z) {file} profil nem olvasható: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>The profile {file} is not there: give the path of a file, or one of {shipped}.</source>
            <translation>A(z) {file} profil nincs meg: adja meg egy fájl útvonalát, vagy ezek egyikét: {shipped}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>it has {count} characters, more than {most}</source>
            <translation>{count} karakterből áll, több mint {most}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} cannot be read: this QGIS runs Python older than 3.11, which reads no TOML. Save the profile with the same keys as JSON and choose that file.</source>
            <translation>{file} nem olvasható: ez a QGIS 3.11-nél régebbi Pythont futtat, amely nem olvas TOML-t. Mentse a profilt ugyanazokkal a kulcsokkal JSON-ként, és válassza azt a fájlt.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is no profile: write an object with name and layers.</source>
            <translation>{file} nem profil: írjon egy objektumot name és layers kulccsal.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file} is not valid {kind}: {error}. Correct that place.</source>
            <translation>{file} nem érvényes {kind}: {error}. Javítsa ki azt a helyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: layers is missing or empty: write one table [[layers]] or more.</source>
            <translation>{file}: a layers hiányzik vagy üres: írjon egy vagy több [[layers]] táblát.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} fits no layer: write names = ["*building*"] or fields = ["building"].</source>
            <translation>{file}: {key} egyik rétegre sem illik: írja így: names = ["*building*"] vagy fields = ["building"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key} is {content!r}: write a table [[layers]].</source>
            <translation>{file}: {key} értéke {content!r}: írjon egy [[layers]] táblát.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.geometry is {geometry!r}: write one of {geometries}.</source>
            <translation>{file}: {key}.geometry értéke {geometry!r}: írja ezek egyikét: {geometries}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.role is {role!r}: write one of {roles}.</source>
            <translation>{file}: {key}.role értéke {role!r}: írja ezek egyikét: {roles}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is no QGIS expression: {error}. Correct it.</source>
            <translation>{file}: {key}.{name} nem QGIS-kifejezés: {error}. Javítsa ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {key}.{name} is {value!r}: write a list of texts, such as ["walls"].</source>
            <translation>{file}: {key}.{name} értéke {value!r}: írja szövegek listáját, például ["walls"].</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is no key of a profile: known are {known}. Remove it or correct its name.</source>
            <translation>{file}: {prefix}{name} nem profilkulcs: az ismertek: {known}. Törölje, vagy javítsa ki a nevét.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{file}: {prefix}{name} is {value!r}: write text in quotes.</source>
            <translation>{file}: {prefix}{name} értéke {value!r}: írjon idézőjelbe tett szöveget.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/roles.py" />
            <source>{names} with {fields}</source>
            <translation>{names} ezekkel: {fields}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A position in {crs} has no place in {target} ({error}). Choose the site's CRS as the project's CRS (bottom right in the QGIS window).</source>
            <translation>Egy {crs} helyzetnek nincs helye itt: {target} ({error}). Válassza a telephely vetületét a projekt vetületének (a QGIS ablak jobb alsó sarkában).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>A way accurate to {accuracy:g} m needs the grid {grids}, which is not installed.</source>
            <translation>Egy {accuracy:g} m pontosságú úthoz a(z) {grids} rács kell, amely nincs telepítve.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>By {name} ({exact}).{warning}</source>
            <translation>Művelet: {name} ({exact}).{warning}</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>Layer {layer}: its features may lie metres off on the site. They come from {crs} to {site_crs}. {way} Choose another transformation in the project's properties, or save the layer in the site's CRS by an exact one.</source>
            <translation>{layer} réteg: elemei méterekkel arrébb lehetnek a telephelyen. {crs} vetületből {site_crs} vetületbe kerülnek. {way} Válasszon másik transzformációt a projekt tulajdonságaiban, vagy mentse a réteget egy pontos transzformációval a telephely vetületében.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>PROJ knows no exact way between these two: the place may be off by metres.</source>
            <translation>A PROJ nem ismer pontos utat e kettő között: a hely méterekkel eltérhet.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place is not known: set the layer's CRS (Layer &gt; Set CRS of Layer).</source>
            <translation>A(z) {name} rétegnek nincs vetülete, ezért a helye nem ismert: állítsa be a réteg vetületét (Réteg &gt; Réteg vetületének beállítása).</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} has no CRS, so its place on the site is not known: set the layer's CRS (Layer &gt; Set CRS of Layer), or {tick}.</source>
            <translation>A(z) {name} rétegnek nincs vetülete, így helye a telephelyen nem ismert: állítsa be a réteg vetületét (Réteg &gt; Réteg vetületének beállítása), vagy {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the CRS {site_crs}: give both layers a CRS that says where on the Earth they are.</source>
            <translation>A(z) {name} réteg vetülete {crs}, amelynek nincs ismert kapcsolata ezzel: {site_crs}. Adjon mindkét rétegnek olyan vetületet, amely megmondja, hol vannak a Földön.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The layer {name} is in the CRS {crs}, which has no known relation to the site CRS {site_crs}: choose the layer's CRS as the site CRS, or {tick}.</source>
            <translation>A(z) {name} réteg vetülete {crs}, amelynek nincs ismert kapcsolata a telephely vetületével ({site_crs}): válassza a réteg vetületét a telephely vetületének, vagy {tick}.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site is not known yet. Connect to a gateway first.</source>
            <translation>A telephely még nem ismert. Előbb kapcsolódjon egy átjáróhoz.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>The site {name} is in the CRS {crs}, which this QGIS does not know: its robots cannot be placed on the map. Correct crs in the site's site.toml, or update QGIS.</source>
            <translation>A(z) {name} telephely vetülete {crs}, amelyet ez a QGIS nem ismer: robotjai nem helyezhetők a térképre. Javítsa ki a crs értékét a telephely site.toml fájljában, vagy frissítse a QGIS-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>There is no way from {site} to {crs}. Choose another CRS under Columns.</source>
            <translation>Nincs út innen: {site}, ide: {crs}. Válasszon másik vetületet az Oszlopok alatt.</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accuracy not known</source>
            <translation>pontossága nem ismert</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>accurate to {accuracy:g} m</source>
            <translation>pontossága {accuracy:g} m</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>exact</source>
            <translation>pontos</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>no change: it is the site's CRS</source>
            <translation>nincs változás: ez a telephely vetülete</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>not a finite place</source>
            <translation>nem véges hely</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>nothing is known of how the two lie to each other</source>
            <translation>nem tudható, hogyan fekszik a kettő egymáshoz képest</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>site frame</source>
            <translation>telephelyi keret</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>the default operation of PROJ</source>
            <translation>a PROJ alapértelmezett művelete</translation>
        </message>
        <message>
            <location filename="../../plugin/layers/site_transform.py" />
            <source>tick 'Layers without a CRS are in metres of the site' (LOCAL=true)</source>
            <translation>jelölje be: „A vetület nélküli rétegek telephelyi méterben vannak” (LOCAL=true)</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>Robots</source>
            <translation>Robotok</translation>
        </message>
        <message>
            <location filename="../../plugin/locator.py" />
            <source>{state}, heard of {age:.0f} s ago</source>
            <translation>{state}, utolsó hír {age:.0f} s óta</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>All robots cannot be followed.</source>
            <translation>Az összes robot nem követhető.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>No robot is selected to be followed. Select one in the table or on the map.</source>
            <translation>Nincs követendő kijelölt robot. Jelöljön ki egyet a táblázatban vagy a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/live_view.py" />
            <source>{robot} has not said yet where it is; the map cannot go there.</source>
            <translation>{robot} még nem mondta meg, hol van; a térkép nem tud odamenni.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>, {remaining:.1f} m to go</source>
            <translation>, még {remaining:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>accuracy</source>
            <translation>pontosság</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>battery</source>
            <translation>akkumulátor</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>heading</source>
            <translation>irány</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>it says</source>
            <translation>ezt mondja</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>last message</source>
            <translation>utolsó üzenet</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>place</source>
            <translation>hely</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>speed</source>
            <translation>sebesség</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>task</source>
            <translation>feladat</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>why</source>
            <translation>miért</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{age_in_words} ago, {escape}</source>
            <translation>{age_in_words}, {escape}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{v:.2f} m/s</source>
            <translation>{v:.2f} m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>{x:.2f}, {y:.2f} m in the site</source>
            <translation>{x:.2f}, {y:.2f} m a telephelyen</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/fleet_overlay.py" />
            <source>± {accuracy:.2f} m</source>
            <translation>± {accuracy:.2f} m</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/overlay/grouped_robots.py" />
            <source>%n robots here, shown as a density; zoom in to see each</source>
            <translation>
                <numerusform>%n robot itt, sűrűségként; nagyítson, hogy mindegyik látható legyen</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{days:.0f} d</source>
            <translation>{days:.0f} nap</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{hours:.0f} h</source>
            <translation>{hours:.0f} óra</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{minutes:.0f} min</source>
            <translation>{minutes:.0f} perc</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>{seconds:.0f} s</source>
            <translation>{seconds:.0f} s</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/labels.py" />
            <source>· offline</source>
            <translation>· offline</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/task_painter.py" />
            <source>{km:.0f} km</source>
            <translation>{km:.0f} km</translation>
        </message>
        <message>
            <location filename="../../plugin/map/overlay/task_painter.py" />
            <source>{metres:.0f} m</source>
            <translation>{metres:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Accuracy (m)</source>
            <translation>Pontosság (m)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Age (s)</source>
            <translation>Kor (s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Battery (0 to 1)</source>
            <translation>Akku (0–1)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Closed roads</source>
            <translation>Lezárt utak</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Command</source>
            <translation>Parancs</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Cones put down</source>
            <translation>Lerakott bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Conflicts</source>
            <translation>Ütközések</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Heading (°)</source>
            <translation>Irány (°)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Link</source>
            <translation>Kapcs.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robot</source>
            <translation>Robot</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Robots (live)</source>
            <translation>Robotok (élő)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Speed (m/s)</source>
            <translation>Sebesség (m/s)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Status</source>
            <translation>Állapotszöveg</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>Theta (rad)</source>
            <translation>Théta (rad)</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>closed</source>
            <translation>lezárva</translation>
        </message>
        <message>
            <location filename="../../plugin/map/reported_layers.py" />
            <source>until</source>
            <translation>eddig:</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Close road</source>
            <translation>Út lezárása</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Closed</source>
            <translation>Lezárva</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open it again for every robot?</source>
            <translation>Megnyitja újra minden robotnak?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Open road</source>
            <translation>Út megnyitása</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>Reason</source>
            <translation>Ok</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>The road is closed for every robot from this junction to the next. Robots whose way leads along it get another way; one that has no other way is stopped, unless the site's settings say otherwise.</source>
            <translation>Az út minden robot elől le lesz zárva ettől a kereszteződéstől a következőig. Azok a robotok, amelyek útja erre vezet, más utat kapnak; amelyiknek nincs más, megáll, hacsak a telephely beállításai mást nem mondanak.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 1 hour</source>
            <translation>1 órára</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 15 minutes</source>
            <translation>15 percre</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>for 4 hours</source>
            <translation>4 órára</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>such as: tree on the road</source>
            <translation>például: fa az úton</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>until it is opened</source>
            <translation>amíg meg nem nyitják</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/click_tools.py" />
            <source>{by} closed this road at {time}{because}</source>
            <translation>{by} zárta le ezt az utat {time}-kor{because}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>No robot is selected, so there is nobody to send there. Select one in the table or on the map.</source>
            <translation>Nincs kijelölt robot, így nincs, akit oda küldjön. Jelöljön ki egyet a táblázatban vagy a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>Select a robot first, in the table or on the map.</source>
            <translation>Előbb jelöljön ki egy robotot a táblázatban vagy a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>The site or the map's CRS has changed meanwhile. Draw the start position again.</source>
            <translation>A telephely vagy a térkép vetülete közben megváltozott. Rajzolja meg újra a kiinduló helyzetet.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to do again.</source>
            <translation>Nincs mit megismételni.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>There is nothing to take back.</source>
            <translation>Nincs mit visszavonni.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/drawing_tools.py" />
            <source>{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.</source>
            <translation>{in_words} még a térképen van. Előbb küldje el (Enter) vagy vesse el (Esc).</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No layer of the project has the role road surface: set it in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>A projekt egyik rétegének sem útfelület a szerepe: állítsa be a Modulok &gt; Fleet Supervisor &gt; Rétegszerepek ablakban.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>No road surface</source>
            <translation>Nincs útfelület</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Tell the road surface under the cursor; a click says it with its coordinates, Esc ends</source>
            <translation>A kurzor alatti útfelületet mutatja; kattintás a koordinátáival együtt mondja, az Esc befejezi</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>The ways to the %n places clicked last were not known yet, so they are not in the route.</source>
            <translation>
                <numerusform>A legutóbb kattintott %n helyre vezető út még nem volt ismert, ezért nincs benne az útvonalban.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>This leg does not follow the roads: {note}</source>
            <translation>Ez a szakasz nem követi az utakat: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>Which road surface is here?</source>
            <translation>Milyen útfelület van itt?</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no CRS</source>
            <translation>nincs vetület</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>no road surface</source>
            <translation>nincs útfelület</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>road surface without a class</source>
            <translation>osztály nélküli útfelület</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{surface} at {where}</source>
            <translation>{surface} itt: {where}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/map/tools/road_tools.py" />
            <source>{why} (Nor are the %n places clicked after it in the route.)</source>
            <translation>
                <numerusform>{why} (Az utána kattintott %n hely sincs benne az útvonalban.)</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>A route needs at least two points, so its drawing goes on: click the next one.</source>
            <translation>Egy útvonalhoz legalább két pont kell, ezért a rajzolás folytatódik: kattintson a következőre.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Keep off roads on which other robots are sent</source>
            <translation>Kerülje el az utakat, amelyeken más robotok vannak úton</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Lead ways so</source>
            <translation>Így vezessen</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Surfaces</source>
            <translation>Felületek</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>The route on the map is for {robot}, but {selected} is selected. Send it (Enter) or cancel it (Esc) first, or select {robot} again.</source>
            <translation>A térképen lévő útvonal ehhez tartozik: {robot}, de {selected} van kijelölve. Előbb küldje el (Enter) vagy vesse el (Esc), vagy jelölje ki újra ezt: {robot}.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This holds for every leg that is led from now on, until QGIS is closed.</source>
            <translation>Ez minden ezután vezetett szakaszra érvényes, a QGIS bezárásáig.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>This is the first vertex: another is put before one that comes later.</source>
            <translation>Ez az első töréspont: másikat csak egy későbbi elé lehet tenni.</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Way</source>
            <translation>Út</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Ways on roads</source>
            <translation>Útvonalak utakon</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>Width</source>
            <translation>Szélesség</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>all, or such as: asphalt, concrete</source>
            <translation>mind, vagy például: asphalt, concrete</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>as wide as the robots are</source>
            <translation>amilyen szélesek a robotok</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the fastest</source>
            <translation>a leggyorsabb</translation>
        </message>
        <message>
            <location filename="../../plugin/map/tools/route_tool.py" />
            <source>the shortest</source>
            <translation>a legrövidebb</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Accept</source>
            <translation>Elfogadás</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>All are reviewed.</source>
            <translation>Mind el van bírálva.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An image of {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Kép erről: {object}; küldte: {robot}, itt: {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>An object: {object}, told by {robot}, at {x:.2f}, {y:.2f} m.</source>
            <translation>Tárgy: {object}; jelentette: {robot}, itt: {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Draw it on no map</source>
            <translation>Egy térképre se kerüljön</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Go to it on the map</source>
            <translation>Odamegy a térképen</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Height</source>
            <translation>Magasság</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is a</source>
            <translation>Ez egy</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is gone: leave it out of the maps that robots get from now on</source>
            <translation>Eltűnt: maradjon ki azokból a térképekből, amelyeket a robotok ezután kapnak</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It is there: leave it on the maps</source>
            <translation>Ott van: maradjon a térképeken</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It stands there: draw it on the maps that robots get from now on</source>
            <translation>Ott áll: kerüljön rá a térképekre, amelyeket a robotok mostantól kapnak</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>It waits for your review.</source>
            <translation>Az Ön bírálatára vár.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Look at it: is it of use?</source>
            <translation>Nézze meg: használható?</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>No robot has told of an object or image yet.</source>
            <translation>Még egy robot sem jelentett tárgyat vagy képet.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Not there any more? {robot} looks through {what} ({source}) of its map again and again, at {x:.2f}, {y:.2f} m.</source>
            <translation>Már nincs ott? {robot} újra meg újra átlát a térképén szereplő {what} ({source}) helyén, itt: {x:.2f}, {y:.2f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Objects and images that robots told of, to be accepted for the maps or rejected</source>
            <translation>Tárgyak és képek, amelyekről a robotok jelentettek: elfogadhatók a térképekre vagy elutasíthatók</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {number} was not reviewed: {why}</source>
            <translation>A(z) {number}. megfigyelés nem lett elbírálva: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observation {observation} was NOT reviewed: {error}</source>
            <translation>A(z) {observation}. megfigyelés NEM lett elbírálva: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations</source>
            <translation>Megfigyelések</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Observations ({waiting})</source>
            <translation>Megfigyelések ({waiting})</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Radius</source>
            <translation>Sugár</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Reject</source>
            <translation>Elutasítás</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show</source>
            <translation>Mutat</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>Show reviewed ones, too</source>
            <translation>Az elbíráltak is látszanak</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}, by {by}. A new review takes the place of that.</source>
            <translation>Állapot: {state}; bírálta: {by}. Egy új bírálat ennek helyébe lép.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>State: {state}. A new review takes the place of that.</source>
            <translation>Állapot: {state}. Egy új bírálat ennek helyébe lép.</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>not known</source>
            <translation>nem ismert</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>object</source>
            <translation>tárgy</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>optional</source>
            <translation>nem kötelező</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_dock.py" />
            <source>{waiting} to be reviewed</source>
            <translation>{waiting} vár elbírálásra</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>Observation {number} at {x:.2f}, {y:.2f} m; double click goes there</source>
            <translation>{number}. megfigyelés itt: {x:.2f}, {y:.2f} m; dupla kattintásra odamegy</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>What robots saw is not known: {error}</source>
            <translation>Nem tudni, mit láttak a robotok: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>accepted</source>
            <translation>elfogadva</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>image</source>
            <translation>kép</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>not there any more: {what}</source>
            <translation>már nincs ott: {what}</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>rejected</source>
            <translation>elutasítva</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>to be reviewed</source>
            <translation>elbírálásra vár</translation>
        </message>
        <message>
            <location filename="../../plugin/observations/observation_views.py" />
            <source>{state} by {by}</source>
            <translation>{state}, bírálta: {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Folder for files that are written</source>
            <translation>A kiírt fájlok &amp;mappája</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>&amp;Size of robots on the map</source>
            <translation>A robotok &amp;mérete a térképen</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>1 is as they come</source>
            <translation>1: az eredeti méret</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Alarms</source>
            <translation>Riasztások</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Arrows show how each robot is, and move with every position. The layer shows what its style says, as often as it is written anew; while it is not on the map there are arrows</source>
            <translation>A nyilak mutatják, hogyan van egy-egy robot, és minden helyzettel mozognak. A réteg azt mutatja, amit a stílusa mond, olyan gyakran, ahogy újraíródik; amíg nincs a térképen, nyilak láthatók</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>At most; from the next connection on. Fewer spare a slow network</source>
            <translation>Legfeljebb; a következő kapcsolattól érvényes. A kevesebb kíméli a lassú hálózatot</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Connections</source>
            <translation>Kapcsolatok</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Fleet Supervisor &amp;help</source>
            <translation>A Fleet Supervisor &amp;súgója</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Layer of robots written anew &amp;every</source>
            <translation>A robotok rétege &amp;újraíródik ennyi időnként</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Map and files</source>
            <translation>Térkép és fájlok</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Positions asked for, &amp;times a second</source>
            <translation>Kért helyzetek &amp;száma másodpercenként</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>Robots are &amp;drawn by</source>
            <translation>Robotok &amp;rajzolója</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>The layer Robots (live): attribute table, labels, expressions. The live map goes its own way</source>
            <translation>A Robotok (élő) réteg: attribútumtábla, címkék, kifejezések. Az élő térkép ettől független</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the layer Robots (live), in its style</source>
            <translation>a Robotok (élő) réteg, a maga stílusában</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>the live map: arrows</source>
            <translation>az élő térkép: nyilak</translation>
        </message>
        <message>
            <location filename="../../plugin/options_page.py" />
            <source>your documents</source>
            <translation>az Ön dokumentumai</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>%n lines written to {path}</source>
            <translation>
                <numerusform>%n sor kiírva ide: {path}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge</source>
            <translation>Nyugtázás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Acknowledge all</source>
            <translation>Mind nyugtázása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm</source>
            <translation>Riasztás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Alarm settings</source>
            <translation>Riasztási beállítások</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>By</source>
            <translation>Ki</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>CSV (*.csv)</source>
            <translation>CSV (*.csv)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Every alarm of this session, and who acknowledged it when</source>
            <translation>A munkamenet minden riasztása, és hogy ki mikor nyugtázta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export CSV…</source>
            <translation>CSV exportálása…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Export the log of alarms</source>
            <translation>A riasztások naplójának exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Kind</source>
            <translation>Fajta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log of alarms</source>
            <translation>Riasztások naplója</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Log…</source>
            <translation>Napló…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen every alarm</source>
            <translation>Annak jelzése, hogy minden riasztást látott</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Say that you have seen the chosen alarms</source>
            <translation>Annak jelzése, hogy látta a kiválasztott riasztásokat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Settings…</source>
            <translation>Beállítások…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>Time</source>
            <translation>Idő</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What</source>
            <translation>Mi</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>What is an alarm, and from where on</source>
            <translation>Mi a riasztás, és mettől</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>acknowledged {time} by {operator}</source>
            <translation>nyugtázta {time}: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>it began {times} times</source>
            <translation>{times} alkalommal kezdődött</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over</source>
            <translation>vége</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>over since {time}, not acknowledged yet</source>
            <translation>{time} óta vége, még nincs nyugtázva</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>since {time}</source>
            <translation>{time} óta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the gateway judges it by the published site, and says what it does</source>
            <translation>az átjáró ítéli meg a közzétett telephely alapján, és megmondja, mit tesz</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/alarm_panel.py" />
            <source>the site's settings say after how long (see the robots' state)</source>
            <translation>a telephely beállításai mondják meg, mennyi idő után (lásd a robotok állapotát)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source> at {x:.1f}, {y:.1f} m</source>
            <translation> itt: {x:.1f}, {y:.1f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>began</source>
            <translation>kezdődött</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>ended</source>
            <translation>véget ért</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it could NOT be stopped yet: {why}</source>
            <translation>még NEM sikerült megállítani: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being aborted</source>
            <translation>megszakítás folyamatban</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>it is being paused</source>
            <translation>szüneteltetés folyamatban</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>new</source>
            <translation>új</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>seen</source>
            <translation>látta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the emergency stop holds it</source>
            <translation>a vészleállítás tartja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has aborted its task</source>
            <translation>az átjáró megszakította a feladatát</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>the gateway has paused it</source>
            <translation>az átjáró szüneteltette</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} and {other}</source>
            <translation>{robot} és {other}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is at the obstacle {name}</source>
            <translation>{robot} a(z) {name} akadálynál van</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} is in the keepout {name}</source>
            <translation>{robot} a(z) {name} tiltott területen van</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m (clearance {clearance:.1f} m){where}</source>
            <translation>{robot} {metres:.1f} m-re fog elhaladni {other} mellett (előírt távolság {clearance:.1f} m){where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{robot} will pass {other} at {metres:.1f} m{where}</source>
            <translation>{robot} {metres:.1f} m-re fog elhaladni {other} mellett{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} comes within {metres:.1f} m of {robot} in {seconds:.0f} s</source>
            <translation>{seen} {seconds:.0f} s múlva {metres:.1f} m-en belülre ér ehhez: {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{seen} is {metres:.1f} m from {robot}</source>
            <translation>{seen} {metres:.1f} m-re van ettől: {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text} (it is not heard now)</source>
            <translation>{text} (most nem hallani felőle)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/board.py" />
            <source>{text}; {robot} may be elsewhere</source>
            <translation>{text}; {robot}: lehet, hogy máshol van</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>; last{where}</source>
            <translation>; utoljára{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>at an obstacle</source>
            <translation>akadálynál</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins after standing with a task for</source>
            <translation>ennyi feladattal állás után kezdődik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins below</source>
            <translation>ez alatt kezdődik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far beside the road</source>
            <translation>ennyivel az út mellett kezdődik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so far outside</source>
            <translation>ennyivel kint kezdődik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins so long before</source>
            <translation>ennyivel előbb kezdődik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when less exact than</source>
            <translation>kezdődik, ha ennél pontatlanabb</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>begins when two are nearer than</source>
            <translation>kezdődik, ha kettő közelebb van, mint</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much above that</source>
            <translation>ennyivel felette ér véget</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much below that</source>
            <translation>ennyivel alatta ér véget</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>ends so much further apart</source>
            <translation>ennyivel távolabb ér véget</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>in a keepout</source>
            <translation>tiltott területen</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>low battery</source>
            <translation>merülő akkumulátor</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>near a robot</source>
            <translation>robot közelében</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>off the road</source>
            <translation>az úton kívül</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>outside the site</source>
            <translation>a telephelyen kívül</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>stopped unasked</source>
            <translation>kérés nélkül megállt</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>too close</source>
            <translation>túl közel</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>unsure of its place</source>
            <translation>bizonytalan a helyében</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will come near a robot</source>
            <translation>robot közelébe fog érni</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>will pass too near</source>
            <translation>túl közel fog elhaladni</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} and {other} are {apart:.1f} m apart{where}</source>
            <translation>{robot} és {other} {apart:.1f} m-re vannak egymástól{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} does not know its place: ± {accuracy:.1f} m{where}</source>
            <translation>{robot} nem tudja, hol van: ± {accuracy:.1f} m{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has a task and stands{where}</source>
            <translation>{robot} feladattal áll{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} has {part:.0%} of its battery left</source>
            <translation>{robot} akkumulátora: {part:.0%} maradt</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is lost: nothing is heard of it{last}</source>
            <translation>{robot} elveszett: semmi hír róla{last}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is off the road{where}</source>
            <translation>{robot} letért az útról{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} is outside the site{where}</source>
            <translation>{robot} a telephelyen kívül van{where}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/rules.py" />
            <source>{robot} may not be where it is shown: {why}</source>
            <translation>{robot}: lehet, hogy nem ott van, ahol látszik: {why}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>%n alarms</source>
            <translation>
                <numerusform>%n riasztás</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Nothing is watched: the desk is not connected.</source>
            <translation>Semmi sincs figyelve: a kezelőpult nincs kapcsolódva.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Off the road is not watched: {why}.</source>
            <translation>Az útról letérés nincs figyelve: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>Switched off: {kinds}.</source>
            <translation>Kikapcsolva: {kinds}.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>and %n more alarms: see the log of alarms in the Fleet panel</source>
            <translation>
                <numerusform>és még %n riasztás: lásd a riasztások naplóját a flottapanelen</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces cannot be read: {why}</source>
            <translation>az útfelületek rétegei nem olvashatók: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>layers of road surfaces hold no areas ({names})</source>
            <translation>az útfelületek rétegeiben nincs terület ({names})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>no layer of the project has the role road surface</source>
            <translation>a projekt egyik rétegének sem útfelület a szerepe</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>the road surfaces are being read</source>
            <translation>az útfelületek olvasása folyik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/alarms/watch.py" />
            <source>this desk</source>
            <translation>ez a kezelőpult</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n commands</source>
            <translation>
                <numerusform>%n parancs</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n older commands came.</source>
            <translation>
                <numerusform>%n régebbi parancs érkezett.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/command_log.py" />
            <source>%n steps</source>
            <translation>
                <numerusform>%n lépés</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All commands</source>
            <translation>Minden parancs</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>All robots</source>
            <translation>Minden robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Ask the gateway for older commands</source>
            <translation>Régebbi parancsok kérése az átjárótól</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Commands</source>
            <translation>Parancsok</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export commands</source>
            <translation>Parancsok exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Export…</source>
            <translation>Exportálás…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Failed, aborted, expired</source>
            <translation>Sikertelen, megszakított, lejárt</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Go there</source>
            <translation>Ugrás oda</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>No older commands came.</source>
            <translation>Nem érkezett régebbi parancs.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>None open</source>
            <translation>Nincs nyitott</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older</source>
            <translation>Régebbiek</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: the gateway has not answered for {seconds:g} s. Press Older to ask once more.</source>
            <translation>Régebbi parancsok: az átjáró {seconds:g} s óta nem válaszolt. Nyomja meg a Régebbiek gombot, hogy újra megkérdezze.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Older commands: {why}</source>
            <translation>Régebbi parancsok: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Open</source>
            <translation>Nyitott</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Selected robots</source>
            <translation>Kijelölt robotok</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Show where the chosen command leads to (double click)</source>
            <translation>Megmutatja, hová vezet a kiválasztott parancs (dupla kattintás)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The gateway knows no others.</source>
            <translation>Az átjáró nem ismer többet.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>The log reaches no further back: the newest {asked} of each chosen robot, or of all, are asked for, and {kept} kept. Older ones are in the gateway's database.</source>
            <translation>A napló nem nyúlik ennél régebbre: minden kiválasztott robot, vagy az összes robot legújabb {asked} parancsát kéri le, és {kept} parancsot őriz. A régebbiek az átjáró adatbázisában vannak.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Which commands are listed</source>
            <translation>Mely parancsok vannak a listán</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Whose commands are listed</source>
            <translation>Kinek a parancsai vannak a listán</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>Write what is listed, every step of it, as CSV</source>
            <translation>A lista kiírása minden lépésével CSV-ként</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{commands} and {steps} written to {path}</source>
            <translation>kiírva ide: {path} ({commands}, {steps})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log.py" />
            <source>{what} of {robot} leads to no place.</source>
            <translation>{what} ({robot}) nem vezet sehová.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>Details</source>
            <translation>Részletek</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{metres:.2f} m off</source>
            <translation>{metres:.2f} m eltérés</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_log_model.py" />
            <source>{number} open: {counts}</source>
            <translation>{number} nyitott: {counts}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>&amp;Coordinates</source>
            <translation>&amp;Koordináták</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A coordinate of what is selected is no number. Correct it, or leave it out.</source>
            <translation>A kijelöltek egyik koordinátája nem szám. Javítsa ki, vagy hagyja ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>A route is one line, and {features} of the layer {layer} are meant: select one.</source>
            <translation>Az útvonal egyetlen vonal, és a(z) {layer} rétegből {features} van megadva: jelöljön ki egyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>C&amp;RS</source>
            <translation>&amp;Vetület</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Coordinates</source>
            <translation>Koordináták</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Feature {id} of {layer} has no place in the site's CRS ({error}). Leave it out, or correct the layer's CRS.</source>
            <translation>A(z) {layer} {id}. elemének nincs helye a telephely vetületében ({error}). Hagyja ki, vagy javítsa ki a réteg vetületét.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No layer of points or lines is active. Click one in the Layers panel, then try again.</source>
            <translation>Nincs aktív pont- vagy vonalréteg. Kattintson egyre a Rétegek panelen, és próbálja újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>No robot is selected. Select the one that the draft is for, then try again.</source>
            <translation>Nincs kijelölt robot. Jelölje ki, amelyiknek a vázlat szól, és próbálja újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Set on the map</source>
            <translation>Térképre</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no CRS, so nobody knows where its points are. Set it in the layer's properties.</source>
            <translation>A(z) {layer} rétegnek nincs vetülete, így senki sem tudja, hol vannak a pontjai. Állítsa be a réteg tulajdonságaiban.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has no feature with a place to go to.</source>
            <translation>A(z) {layer} rétegben nincs olyan elem, amelyhez menni lehetne.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has not answered for {seconds:g} s, so no draft was made of it. Bring its server or drive back and try again.</source>
            <translation>A(z) {layer} réteg {seconds:g} másodperce nem válaszol, ezért nem készült belőle vázlat. Tegye újra elérhetővé a kiszolgálóját vagy a meghajtóját, és próbálja újra.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {count} features and a queue takes {longest_queue}: select those that are meant.</source>
            <translation>A(z) {layer} rétegnek {count} eleme van, és egy várólista {longest_queue} darabot fogad: jelölje ki, amelyekről szó van.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} has {places} points selected and a queue takes {longest_queue}: select fewer.</source>
            <translation>A(z) {layer} rétegen {places} pont van kijelölve, és egy várólista {longest_queue} darabot fogad: jelöljön ki kevesebbet.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The layer {layer} holds polygons: take a layer of points (targets) or lines (a route).</source>
            <translation>A(z) {layer} réteg poligonokat tartalmaz: válasszon pontréteget (célok) vagy vonalréteget (útvonal).</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line has {places} vertices; a route takes 2 to {longest_path}: simplify it first.</source>
            <translation>A vonalnak {places} töréspontja van; egy útvonal 2 és {longest_path} közt fogad: előbb egyszerűsítse.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>The line that is selected in {layer} has {parts} parts, and a robot cannot leap from one to the next: make it one line.</source>
            <translation>A(z) {layer} rétegen kijelölt vonal {parts} részből áll, és egy robot nem ugorhat egyikről a másikra: legyen egy vonal.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>Write {order} in {crs}.
{path}</source>
            <translation>Írja be: {order} itt: {crs}.
{path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>{site}; {east:.2f}, {north:.2f} in {crs}.
{path}</source>
            <translation>{site}; {east:.2f}, {north:.2f} itt: {crs}.
{path}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/command_sources.py" />
            <source>{x:.2f}, {y:.2f} m on the site</source>
            <translation>{x:.2f}, {y:.2f} m a telephelyen</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Choose a conflict in the list first.</source>
            <translation>Előbb válasszon egy ütközést a listából.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Give way</source>
            <translation>Elsőbbséget ad</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>No robot is in another one's way.</source>
            <translation>Egyik robot sincs egy másik útjában.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Nobody can be sent aside: {why}</source>
            <translation>Senki sem küldhető félre: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send aside</source>
            <translation>Félreküldés</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Send {robot} aside</source>
            <translation>{robot} félreküldése</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop</source>
            <translation>Megállítás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>Stop {robot}</source>
            <translation>{robot} megállítása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>at {x:.0f}, {y:.0f} m</source>
            <translation>itt: {x:.0f}, {y:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway is being asked</source>
            <translation>az átjáró kérdezése folyik</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>the gateway's answer cannot be read; it may be older than this plugin</source>
            <translation>az átjáró válasza nem olvasható; lehet, hogy régebbi ennél a modulnál</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} gives way</source>
            <translation>{robot} elsőbbséget ad</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} is paused: it stands, and keeps what it is doing for later</source>
            <translation>{robot} szünetel: áll, és későbbre megtartja, amit csinál</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other} or takes another way, whichever gets it there sooner</source>
            <translation>{robot} megvárja ezt: {other}, vagy más utat választ, amelyikkel előbb ér oda</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} waits for {other}, until {time_of_day} at the earliest</source>
            <translation>{robot} vár erre: {other}, legkorábban {time_of_day}-ig</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{robot} × {other}: over</source>
            <translation>{robot} × {other}: vége</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/conflict_panel.py" />
            <source>{text}; the route is shown first, and sent as any other</source>
            <translation>{text}; az útvonal előbb megjelenik, és úgy küldhető, mint bármely más</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Gateway</source>
            <translation>&amp;Átjáró</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Keep under a name…</source>
            <translation>&amp;Őrzés néven…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>&amp;Manage connections…</source>
            <translation>Kapcsolatok &amp;kezelése…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Access…</source>
            <translation>Hozzáférés…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>CA file</source>
            <translation>CA-fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Certificates (*.pem *.crt *.cer);;All files (*)</source>
            <translation>Tanúsítványok (*.pem *.crt *.cer);;Minden fájl (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connect</source>
            <translation>Kapcsolódás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connected</source>
            <translation>Kapcsolódva</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connecting</source>
            <translation>Kapcsolódás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connection: {name}</source>
            <translation>Kapcsolat: {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Connections that are kept under a name</source>
            <translation>Néven őrzött kapcsolatok</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Disconnect</source>
            <translation>Bontás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Encrypted, under the master password of the QGIS authentication manager</source>
            <translation>Titkosítva, a QGIS hitelesítéskezelőjének mesterjelszava alatt</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Failed</source>
            <translation>Sikertelen</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Keep in QGIS</source>
            <translation>Őrzés a QGIS-ben</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Not connected</source>
            <translation>Nincs kapcsolat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying</source>
            <translation>Újrapróbálás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Retrying in {wait:.0f} s</source>
            <translation>Újrapróbálás {wait:.0f} s múlva</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>The site's ca.pem</source>
            <translation>A telephely ca.pem fájlja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Token and CA file, for a gateway with accounts and TLS</source>
            <translation>Token és CA-fájl fiókokkal és TLS-sel működő átjáróhoz</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>Who you are: it stands beside every command in every log</source>
            <translation>Ön: minden naplóban minden parancs mellett áll</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>fleet_op_…, as it was printed when the account was made</source>
            <translation>fleet_op_…, ahogy a fiók létrehozásakor kiíródott</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>kept by QGIS; enter another one to replace it</source>
            <translation>a QGIS őrzi; írjon be másikat a cseréjéhez</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>of the connection's authentication; enter another one for this time</source>
            <translation>a kapcsolat hitelesítéséé; most írhat be másikat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/connection_panel.py" />
            <source>the site's ca.pem; empty for public authorities</source>
            <translation>a telephely ca.pem fájlja; üres: nyilvános kiállítók</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/dock.py" />
            <source>Queue</source>
            <translation>Várólista</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source> since {time}</source>
            <translation> {time} óta</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear the emergency stop?</source>
            <translation>Feloldja a vészleállítást?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Cleared, robots can be sent again. None sets off by itself: what they were doing was aborted.</source>
            <translation>Feloldás után a robotok újra küldhetők. Egyik sem indul el magától: amit csináltak, megszakadt.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Clear…</source>
            <translation>Feloldás…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP asked for. The gateway has not confirmed it yet: watch the robots, and use their own emergency stops.</source>
            <translation>VÉSZLEÁLLÍTÁS kérve. Az átjáró még nem erősítette meg: figyelje a robotokat, és használja saját vészleállítóikat.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>EMERGENCY STOP in force{since}, by {by}{reason}</source>
            <translation>VÉSZLEÁLLÍTÁS érvényben{since}, kérte: {by}{reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>In force at {reached} of {of} gateways</source>
            <translation>{of} átjáró közül {reached} helyen érvényes</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Keep it in force</source>
            <translation>Maradjon érvényben</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>MOVING: {names}</source>
            <translation>MOZOG: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>NOT REACHED: gateways {names}. Watch their robots</source>
            <translation>NEM ELÉRHETŐ átjárók: {names}. Figyelje a robotjaikat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>No answer from {names}</source>
            <translation>Nem válaszol: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not heard now, may move: {names}</source>
            <translation>Most nem hallható, mozoghat: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Not stored yet: the gateway cannot write its database, so robots on SQL are not told.</source>
            <translation>Még nincs tárolva: az átjáró nem tudja írni az adatbázisát, így az SQL-robotok nem értesülnek.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>REFUSED by {names}</source>
            <translation>ELUTASÍTOTTA: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>The gateway has said nothing for {seconds} s: robots may move. It said last:</source>
            <translation>Az átjáró {seconds} másodperce hallgat: a robotok mozoghatnak. Utoljára ezt közölte:</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/emergency.py" />
            <source>Why robots may drive again, for the log</source>
            <translation>Miért indulhatnak újra a robotok, a naplóba</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/emergency.py" />
            <source>{acknowledged} of %n robots acknowledged, {standing} seen to stand</source>
            <translation>
                <numerusform>%n robotból {acknowledged} nyugtázta, {standing} láthatóan áll</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source> Override… sends it all the same, where your role may.</source>
            <translation> A Felülbírálás… mégis elküldi, ha a szerepe engedi.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Map for {robot}</source>
            <translation>Térkép ennek: {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>No robot is selected, so none was sent the map. Select it first.</source>
            <translation>Nincs kijelölt robot, így egyik sem kapott térképet. Előbb jelölje ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Nothing is sent yet.</source>
            <translation>Még semmi sincs elküldve.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override</source>
            <translation>Felülbírálás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Override the checks</source>
            <translation>Az ellenőrzések felülbírálása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Select a robot, choose Cone target or Draw route, and click on the map.</source>
            <translation>Jelöljön ki robotot, válassza a Bójacél vagy az Útvonal rajzolása eszközt, és kattintson a térképre.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>The draft has changed since it was looked at, so nothing was overridden. Press Override again.</source>
            <translation>A vázlat megváltozott, mióta megnézte, így nem lett felülbírálva. Nyomja meg újra a Felülbírálást.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>There is no draft on the map. Select a robot, then set a cone target or draw a route.</source>
            <translation>Nincs vázlat a térképen. Jelöljön ki robotot, majd tegyen bójacélt vagy rajzoljon útvonalat a térképre.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Why it is right all the same</source>
            <translation>Miért helyes mégis</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>Your name, what was found and why go into the gateway's log.</source>
            <translation>Az Ön neve, amit az ellenőrzés talált és az ok az átjáró naplójába kerül.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>because: {reason}</source>
            <translation>mert: {reason}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} is being checked: {share:.0%}. It goes out when nothing speaks against it.</source>
            <translation>{in_words} ellenőrzése folyik: {share:.0%}. Elindul, ha semmi sem szól ellene.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words} was not put into the queue: {fault}</source>
            <translation>{in_words} nem került a várólistára: {fault}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}, into the queue</source>
            <translation>{in_words}, a várólistára</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}.</source>
            <translation>{in_words}. Ellenőrzés alatt: {share:.0%}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Being checked: {share:.0%}. It goes out when nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. Ellenőrzés alatt: {share:.0%}. Elküldésre kerül, ha semmi sem szól ellene; az Esc visszatartja.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. It goes out when that is found and nothing speaks against it; Esc keeps it back.</source>
            <translation>{in_words}. Elküldésre kerül, ha az út megvan, és semmi sem szól ellene; az Esc visszatartja.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. Not to be sent: {found}{hint}</source>
            <translation>{in_words}. Nem küldhető: {found}{hint}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}. OVERRIDDEN: {override}. Enter or Send sends it.</source>
            <translation>{in_words}. FELÜLBÍRÁLVA: {override}. Az Enter vagy a Küldés elküldi.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Add to queue lets them be placed one after the other.</source>
            <translation>{in_words}.{warnings} A Várólistára egymás után helyezteti ki őket.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}.{warnings} Enter or Send sends it.</source>
            <translation>{in_words}.{warnings} Az Enter vagy a Küldés elküldi.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/pending_command_panel.py" />
            <source>{in_words}: there is nothing here that an override would help.</source>
            <translation>{in_words}: itt nincs semmi, amin a felülbírálás segítene.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>A task of {robot} first</source>
            <translation>{robot} egyik feladatának előrehozása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Continue for {robot}</source>
            <translation>Folytatás: {robot}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Do now</source>
            <translation>Most</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot do the selected task at once; what it is doing comes next (Ctrl+Enter)</source>
            <translation>A robot a kijelölt feladatot azonnal végezze; amit csinál, az jön utána (Ctrl+Enter)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Let the robot go on with the task at the head of its queue</source>
            <translation>A robot folytassa a várólistája élén lévő feladattal</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one down (Alt+Down)</source>
            <translation>A kijelölt feladat eggyel lejjebb (Alt+Le)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Move the selected task one up (Alt+Up)</source>
            <translation>A kijelölt feladat eggyel feljebb (Alt+Fel)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Moving a task of {robot}</source>
            <translation>{robot} egyik feladatának áthelyezése</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>No robot is selected, so none was paused. Select it in the table or on the map.</source>
            <translation>Nincs kijelölt robot, így egyik sem lett szüneteltetve. Jelölje ki a táblázatban vagy a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Not done: the queue has changed since you saw it. This is how it stands now.</source>
            <translation>Nem történt meg: a várólista megváltozott, mióta látta. Most így áll.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pause</source>
            <translation>Szünet</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Pausing the queue of {robot}</source>
            <translation>{robot} várólistájának szüneteltetése</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Removing a task of {robot}</source>
            <translation>{robot} egyik feladatának eltávolítása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resume</source>
            <translation>Folytatás</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Resuming the queue of {robot}</source>
            <translation>{robot} várólistájának folytatása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. None has one yet.</source>
            <translation>Jelöljön ki robotot a várólistájához. Még egyiknek sincs.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Select a robot to see its queue. {queues} have one, {paused} of them paused.</source>
            <translation>Jelöljön ki robotot a várólistájához. {queues} robotnak van, ebből {paused} szünetel.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Send the robot no further task; what it is doing it finishes (Pause robot stops it)</source>
            <translation>A robot nem kap több feladatot; amit csinál, befejezi (a Robot szüneteltetése megállítja)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Take the selected task out (Delete)</source>
            <translation>A kijelölt feladat kivétele (Delete)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>Task</source>
            <translation>Feladat</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The gateway has not answered yet what was asked of the queue of {robot} before. Try again in a moment.</source>
            <translation>Az átjáró még nem válaszolt arra, amit {robot} várólistájától előbb kért. Próbálja újra egy pillanat múlva.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The link was lost before the answer, and the queue has changed, perhaps by this. So it stands now.</source>
            <translation>A kapcsolat a válasz előtt megszakadt, és a várólista megváltozott, talán éppen ettől. Most így áll.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>The queue of {robot} was paused just before the click, so it was not resumed. Press Resume again to let it continue.</source>
            <translation>{robot} várólistáját közvetlenül a kattintás előtt szüneteltették, ezért nem folytatódott. Nyomja meg újra a Folytatás gombot, hogy folytassa.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>added by {by}</source>
            <translation>hozzáadta: {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>waiting: robot</source>
            <translation>vár: robot</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues</source>
            <translation>{robot} folytatja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{robot} continues with {task}</source>
            <translation>{robot} ezzel folytatja: {task}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/queue.py" />
            <source>{selected} has no queue. Add a target or a route with Add to queue.</source>
            <translation>{selected} robotnak nincs várólistája. Adjon hozzá célt vagy útvonalat a Várólistára gombbal.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>, {metres:.2f} m off</source>
            <translation>, {metres:.2f} m eltérés</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask again</source>
            <translation>Újra kérés</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Ask for the robot's last image and its commands again</source>
            <translation>A robot utolsó képének és parancsainak újbóli kérése</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Diagnostics as received</source>
            <translation>Diagnosztika, ahogy érkezett</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>It says</source>
            <translation>Ezt mondja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>No image: {why}</source>
            <translation>Nincs kép: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Now</source>
            <translation>Most</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Off path or target</source>
            <translation>Eltérés a pályától vagy a céltól</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Position, {crs}</source>
            <translation>Helyzet, {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Reading a robot's image</source>
            <translation>Egy robot képének olvasása</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Select a robot in the table or on the map</source>
            <translation>Jelöljön ki robotot a táblázatban vagy a térképen</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>The image that came cannot be read: it is none of a kind that QGIS knows.</source>
            <translation>A megérkezett kép nem olvasható: nem a QGIS által ismert fajta.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>Why elsewhere</source>
            <translation>Miért máshol</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>and {more} more</source>
            <translation>és még {more}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>looking for an image …</source>
            <translation>kép keresése …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>the image is coming …</source>
            <translation>jön a kép …</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{command}, by {operator}</source>
            <translation>{command}, kérte: {operator}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot} has sent no image lately</source>
            <translation>{robot} nem küldött képet mostanában</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_details.py" />
            <source>{robot}, selected last of several</source>
            <translation>{robot}, a kijelöltek közül az utolsó</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Age</source>
            <translation>Kor</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Batt.</source>
            <translation>Akku</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far it is beside its path, or from the target that it reached last</source>
            <translation>Mennyire van a pályája mellett, vagy az utoljára elért célja mellett</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How far what is known of it can be trusted</source>
            <translation>Mennyire megbízható, amit tudni róla</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How full its battery is</source>
            <translation>Mennyire van töltve az akkumulátora</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How it is connected; @ and a name: at another gateway</source>
            <translation>Hogyan kapcsolódik; @ és egy név: másik átjárónál</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long ago anything was heard of it</source>
            <translation>Mióta nem hallani róla</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>How long its link takes there and back</source>
            <translation>Mennyi idő alatt ér oda-vissza a kapcsolata</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Its speed, as it says</source>
            <translation>A sebessége, ahogy mondja</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Off</source>
            <translation>Eltér</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Ping</source>
            <translation>Ping</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Position</source>
            <translation>Helyzet</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Speed</source>
            <translation>Sebesség</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>The robot's name</source>
            <translation>A robot neve</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>What it is doing, or what it says</source>
            <translation>Mit csinál, vagy mit mond</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>Where it is, in the CRS chosen under Columns</source>
            <translation>Hol van, az Oszlopok alatt választott vetületben</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>at {x:.2f}, {y:.2f} m in the site frame</source>
            <translation>itt: {x:.2f}, {y:.2f} m a telephelyi keretben</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>cone</source>
            <translation>bója</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>it says: {text}</source>
            <translation>ezt mondja: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>its link takes {ms:.1f} ms there and back</source>
            <translation>a kapcsolata {ms:.1f} ms alatt ér oda-vissza</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>on route</source>
            <translation>úton</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>paused</source>
            <translation>szünetel</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>route</source>
            <translation>útvonal</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>stopped</source>
            <translation>megállt</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>target</source>
            <translation>cél</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to cone</source>
            <translation>a bójához</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_model.py" />
            <source>to target</source>
            <translation>a céljához</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Another CRS…</source>
            <translation>Másik vetület…</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>CRS of the project ({crs})</source>
            <translation>A projekt vetülete ({crs})</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Columns</source>
            <translation>Oszlopok</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Latitude, longitude (WGS 84)</source>
            <translation>Szélesség, hosszúság (WGS 84)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Name, state, task or link; several words have to be there all</source>
            <translation>Név, állapot, feladat vagy kapcsolat; több szónál mindnek szerepelnie kell</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Positions in: {crs}</source>
            <translation>Helyzetek itt: {crs}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search</source>
            <translation>Keresés</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Search robots</source>
            <translation>Robotok keresése</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Site frame (metres)</source>
            <translation>Telephelyi keret (méter)</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>The search finds others by name.</source>
            <translation>A keresés a többit név szerint megtalálja.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Which columns are shown, and in which CRS positions are</source>
            <translation>Mely oszlopok látszanak, és milyen vetületben vannak a helyzetek</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With a task</source>
            <translation>Feladattal</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>With alarms, or not fresh</source>
            <translation>Riasztással, vagy nem friss</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>Without a task</source>
            <translation>Feladat nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>no such place</source>
            <translation>nincs ilyen hely</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/robot_table.py" />
            <source>{listed} of {all}</source>
            <translation>{listed} / {all}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source> Without a role, since other layers of the project have it: {layers}. Plugins &gt; Fleet Supervisor &gt; Layer roles changes that.</source>
            <translation> Szerep nélkül, mert a projekt más rétegeié: {layers}. A Modulok &gt; Fleet Supervisor &gt; Rétegszerepek menüben módosítható.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Closed before the gateway answered, so it may be done or not: {asked}</source>
            <translation>Bezárva, mielőtt az átjáró válaszolt volna, ezért nem ismert, hogy végrehajtódott-e: {asked}</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>No emergency stop is in force.</source>
            <translation>Nincs érvényben vészleállítás.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit all the same</source>
            <translation>Kilépés mégis</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Quit before the gateway has answered?</source>
            <translation>Kilép, mielőtt az átjáró válaszol?</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Stay</source>
            <translation>Maradok</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>Targets and routes</source>
            <translation>Célok és útvonalak</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The gateway has not answered yet: {asked}. Who quits now does not learn whether it is done, and what is not sent yet never is.</source>
            <translation>Az átjáró még nem válaszolt: {asked}. Aki most kilép, nem tudja meg, hogy végrehajtódik-e, és ami még nem lett elküldve, sosem lesz.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>The site in {folder} is in the project already: {names}.</source>
            <translation>A(z) {folder} mappában lévő telephely már a projektben van: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/panel/window.py" />
            <source>This project is not that of site {site}: its variables have another origin, CRS or rotation. Checks and alarms go by the layers of this project: open the site's.</source>
            <translation>Ez a projekt nem a(z) {site} telephelyé: változóiban más az origó, a CRS vagy az elforgatás. Az ellenőrzések és a riasztások ennek a projektnek a rétegei szerint mennek: nyissa meg a telephelyét.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/panel/window.py" />
            <source>{site}: %n layers loaded.</source>
            <translation>
                <numerusform>{site}: %n réteg betöltve.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones</source>
            <translation>
                <numerusform>%n bója</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>%n cones placed</source>
            <translation>
                <numerusform>%n bója kihelyezve</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>, {collected} collected again</source>
            <translation>, {collected} újra begyűjtve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>As-placed report</source>
            <translation>Kihelyezési jelentés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Collected</source>
            <translation>Begyűjtve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Cone</source>
            <translation>Bója</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Figures, histogram, map and table of these cones as a PDF</source>
            <translation>Ezeknek a bójáknak a számai, hisztogramja, térképe és táblázata PDF-ben</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>No cone was put down yet.</source>
            <translation>Még nincs bója letéve.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Off [m]</source>
            <translation>Eltérés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Placed</source>
            <translation>Kihelyezve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Plan collecting</source>
            <translation>Begyűjtés tervezése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Planned x, y</source>
            <translation>Tervezett x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Refresh</source>
            <translation>Frissítés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Report…</source>
            <translation>Jelentés…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Save as CSV…</source>
            <translation>Mentés CSV-ként…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>Stands at x, y</source>
            <translation>Itt áll: x, y</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>The report is made by QGIS's Processing: switch that on in Plugins &gt; Manage and Install Plugins.</source>
            <translation>A jelentést a QGIS Feldolgozás modulja készíti: kapcsolja be a Modulok &gt; Modulok kezelése és telepítése ablakban.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>everything</source>
            <translation>minden</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>layout {name}</source>
            <translation>{name} elrendezés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>off by {mean:.3f} m on average, at most {largest:.3f} m</source>
            <translation>átlagos eltérés {mean:.3f} m, legfeljebb {largest:.3f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>the plan that is driven</source>
            <translation>a végrehajtás alatt lévő terv</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} of %n cones placed</source>
            <translation>
                <numerusform>%n bójából {cones} kihelyezve</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{cones} written to {path}</source>
            <translation>kiírva ide: {path} ({cones})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/as_placed.py" />
            <source>{placed}{gone}; {off}</source>
            <translation>{placed}{gone}; {off}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A new plan was sent by itself, as was switched on: {why}</source>
            <translation>Új terv ment ki magától, ahogy be volt kapcsolva: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>A plan is being driven. Plan what is left, choose New plan to plan for other robots, or press Clear: nobody follows it then, and robots go on with their queues.</source>
            <translation>Egy terv végrehajtás alatt van. Tervezze meg a maradékot, más robotoknak az Új terv választásával tervezzen, vagy nyomja meg a Törlést: akkor senki sem követi, és a robotok folytatják várólistáikat.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Clearing the cone plan</source>
            <translation>A bójaterv törlése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on as before</source>
            <translation>Folytatás a régi szerint</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Going on with the cone plan</source>
            <translation>A bójaterv folytatása</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No new cone plan was sent by itself: {why}.</source>
            <translation>Nem ment ki magától új bójaterv: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>No plan is being driven, or something is still being sent.</source>
            <translation>Nincs végrehajtás alatt terv, vagy még küldés folyik.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Nothing was overridden: what was refused is no longer being sent. Look at the plan.</source>
            <translation>Semmi sem lett felülbírálva: amit az átjáró visszautasított, azt már nem küldi senki. Nézze meg a tervet.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Pause of the cone plan</source>
            <translation>A bójaterv szüneteltetése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Paused: {robots} ({why})</source>
            <translation>Szünetel: {robots} ({why})</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Plan of what is left</source>
            <translation>A maradék terve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>Sending the cone plan</source>
            <translation>A bójaterv elküldése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan cannot go on as it is: {why}. Plan what is left.</source>
            <translation>A bójaterv így nem folytatható: {why}. Tervezze meg a maradékot.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is in the robots' queues.</source>
            <translation>A bójaterv a robotok várólistáin van.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan is paused: {why}.</source>
            <translation>A bójaterv szünetel: {why}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The cone plan was not sent. {words}: {found} Override… in the panel Cone plan sends it all the same, where your role may.</source>
            <translation>A bójaterv nem ment el. {words}: {found} A Bójaterv panelen a Felülbírálás… mégis elküldi, ha a szerepe engedi.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The gateway is older than this plugin and drives no cone plans: plans are made and looked at here, and nothing of them is sent. Update the gateway, or give robots their cones with Add to queue.</source>
            <translation>Az átjáró régebbi, mint ez a bővítmény, és nem hajt végre bójaterveket: terveket itt lehet készíteni és megnézni, de semmi sem megy ki belőlük. Frissítse az átjárót, vagy a Várólistára gombbal adjon bójákat a robotoknak.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The new cone plan</source>
            <translation>Az új bójaterv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>The plan cannot be sent: {error}</source>
            <translation>A terv nem küldhető el: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no new plan to confirm.</source>
            <translation>Nincs megerősíthető új terv.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>There is no plan to send. Make one with Preview or Solve first.</source>
            <translation>Nincs elküldhető terv. Készítsen egyet előbb az Előnézet vagy a Megoldás gombbal.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/execution.py" />
            <source>{by} cleared the cone plan: nobody follows it any more, and robots go on with their queues.</source>
            <translation>{by} törölte a bójatervet: senki sem követi már, és a robotok folytatják várólistáikat.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>A cone takes</source>
            <translation>Egy bója ideje</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard</source>
            <translation>Rajta</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter</source>
            <translation>Rajta: a roboton most lévő bóják. Hatótáv: az akkumulátor méterei, 0, ha nem számít</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>At the end</source>
            <translation>A végén</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Carries</source>
            <translation>Elvisz</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Cones</source>
            <translation>Bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>How it is planned</source>
            <translation>Hogyan készül a terv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Least</source>
            <translation>Legkevesebb</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off cones by</source>
            <translation>Bójáktól ennyire</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Off robots by</source>
            <translation>Robotoktól ennyire</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Only the features of the layer that are selected</source>
            <translation>Csak a réteg kijelölt elemei</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Range</source>
            <translation>Hatótáv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Robots that come nearer to one another by the plan are named</source>
            <translation>A terv szerint ennél közelebb kerülő robotok meg lesznek nevezve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Solve for at most</source>
            <translation>Megoldás legfeljebb</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Stores</source>
            <translation>Raktárak</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Straight within</source>
            <translation>Egyenesen ezen belül</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>The layers of the project with the role road centreline</source>
            <translation>A projekt úttengely szerepű rétegei</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>Ways are led round cones by so much</source>
            <translation>Az utak ennyivel kerülik a bójákat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>along the roads of the project</source>
            <translation>a projekt útjai mentén</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>choose a layer of points</source>
            <translation>válasszon pontréteget</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>m/s</source>
            <translation>m/s</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>selected</source>
            <translation>kijelölt</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{column} of {robot} is {text!r}: give {least:g} or more.</source>
            <translation>{robot} {column} értéke {text!r}: adjon meg legalább {least:g} értéket.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/forms.py" />
            <source>{name} is away: it takes no part</source>
            <translation>{name} nincs jelen: nem vesz részt</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Degrees clockwise from north; the wheel over the map turns it too</source>
            <translation>Fok északtól az óramutató járása szerint; a görgő a térkép felett is forgatja</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Heading</source>
            <translation>Irány</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Remove the cones that were placed last; Ctrl+Z over the map does so too</source>
            <translation>A legutóbb elhelyezett bóják eltávolítása; a térkép fölött a Ctrl+Z is ezt teszi</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Reset to the standard</source>
            <translation>Vissza a szabványhoz</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Standard: {value}</source>
            <translation>Szabvány: {value}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>Take back the last layout</source>
            <translation>Az utolsó elrendezés visszavonása</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/dimensions.py" />
            <source>too many cones; a plan has {most} at most</source>
            <translation>túl sok bója; egy tervben legfeljebb {most} lehet</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The cones of the layer {layer} are not saved with the project: {problem}. Export the layer to a file before you close QGIS.</source>
            <translation>A(z) {layer} réteg bójái nem mentődtek a projekttel: {problem}. Exportálja a réteget fájlba, mielőtt bezárja a QGIS-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer of cones is another one now: place the layout again.</source>
            <translation>A bóják rétege most másik: helyezze el újra az elrendezést.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones without the fields {fields}: add them, or remove the layer.</source>
            <translation>A(z) {layer} réteg nem fogad bójákat e mezők nélkül: {fields}. Vegye fel őket, vagy távolítsa el a réteget.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The layer {layer} takes no cones: make it writable, or remove it.</source>
            <translation>A(z) {layer} réteg nem fogad bójákat: tegye írhatóvá, vagy távolítsa el.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>The project has no CRS: choose one in metres, at the bottom right in QGIS.</source>
            <translation>A projektnek nincs vetülete: válasszon egy métereset, a QGIS jobb alsó sarkában.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>the project is not a file</source>
            <translation>a projekt nem fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be read again</source>
            <translation>{path} nem olvasható vissza</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_layer.py" />
            <source>{path} cannot be written ({words})</source>
            <translation>{path} nem írható ({words})</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>%n cones are in the layer {layer}.</source>
            <translation>
                <numerusform>%n bója van a(z) {layer} rétegben.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place a cone layout: it is shown under the cursor, the wheel turns it, with Shift finely, a click places it, Ctrl+Z takes it back, Esc ends; by keys PgUp and PgDown turn it, Enter places it, F2 leads to its dimensions. Nothing is sent to robots</source>
            <translation>Bójaelrendezés elhelyezése: a kurzornál látszik, a görgő forgatja, Shifttel finoman, egy kattintás elhelyezi, a Ctrl+Z visszavonja, az Esc befejezi; billentyűkkel a PgUp és a PgDown forgatja, az Enter elhelyezi, az F2 a méreteihez vezet. A robotoknak semmi sem megy</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>Place cone layout</source>
            <translation>Bójaelrendezés elhelyezése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>The cones in the layer {layer} were not checked: {why}</source>
            <translation>A(z) {layer} réteg bójáit senki sem ellenőrizte: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>layers of road surfaces and obstacles have not been read within {seconds:g} s</source>
            <translation>az útfelületek és akadályok rétegeit {seconds:g} másodperc alatt nem sikerült beolvasni</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/layouts/layout_tool.py" />
            <source>{wrong} of %n cones should not stand there: {text} All are in the layer {layer}.</source>
            <translation>
                <numerusform>%n bójából {wrong} nem állhat ott: {text} Mind a(z) {layer} rétegben van.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>%n ways lead along closed roads</source>
            <translation>
                <numerusform>%n út vezet lezárt utakon</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A good plan, within the time that is given</source>
            <translation>Jó terv a megadott időn belül</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A new plan, or one that the gateway drives, whoever submitted it</source>
            <translation>Új terv, vagy egy, amelyet az átjáró hajt végre, bárki küldte is</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>A quick plan, to look at</source>
            <translation>Gyors terv, megnézésre</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>As placed</source>
            <translation>Kihelyezve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Being sent …</source>
            <translation>Küldés folyik …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Clear</source>
            <translation>Törlés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Cone plan</source>
            <translation>Bójaterv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Confirm new plan</source>
            <translation>Új terv megerősítése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Do not send</source>
            <translation>Ne küldje</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Done: {done} of %n cones</source>
            <translation>
                <numerusform>Kész: %n bójából {done}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Follow the plan no more, at no desk; robots go on with their queues</source>
            <translation>A tervet egyik kezelőpult sem követi tovább; a robotok folytatják várólistáikat</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Give up what is being planned</source>
            <translation>A folyó tervezés feladása</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Go on as before</source>
            <translation>Folytatás, mint eddig</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Hold the robots once they have finished what they are doing, and plan what is left; nothing else is sent before you confirm</source>
            <translation>Visszatartja a robotokat, ha befejezték, amit csinálnak, és megtervezi a maradékot; a megerősítésig semmi más nem megy ki</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Let them go on</source>
            <translation>Folytassák</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan</source>
            <translation>Új terv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>New plan, not sent yet: {summary}</source>
            <translation>Új terv, még nincs elküldve: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>No plan. Choose cones and robots, then Preview or Solve.</source>
            <translation>Nincs terv. Válasszon bójákat és robotokat, majd Előnézet vagy Megoldás.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Not sent yet: {summary}</source>
            <translation>Még nincs elküldve: {summary}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Override…</source>
            <translation>Felülbírálás…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Pause the plan</source>
            <translation>Terv szünete</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Placed cones</source>
            <translation>Kihelyezett bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan</source>
            <translation>Terv</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan what is left</source>
            <translation>A maradék tervezése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Plan which robot places or collects which cone, send it, watch it; the as-placed report</source>
            <translation>Megtervezi, melyik robot melyik bóját helyezi ki vagy gyűjti be, elküldi és figyeli; kihelyezési jelentés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Preview</source>
            <translation>Előnézet</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Resume the queues of the plan's robots that somebody paused</source>
            <translation>A terv robotjainak szüneteltetett várólistáit folytatja</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send</source>
            <translation>Küldés</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send new plans without asking</source>
            <translation>Új tervek küldése kérdés nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the cone plan</source>
            <translation>A bójaterv küldése</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan in spite of what was found; asks why</source>
            <translation>A terv elküldése annak ellenére, amit az ellenőrzés talált; megkérdezi, miért</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send the plan's robots no further task; what they are doing they finish</source>
            <translation>A terv robotjai nem kapnak több feladatot; amit végeznek, azt befejezik</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Send…</source>
            <translation>Küldés…</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Solve</source>
            <translation>Megoldás</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>The plan is sent at once, and robots set off.</source>
            <translation>A terv azonnal elmegy, és a robotok elindulnak.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>Under way: {done} of %n cones</source>
            <translation>
                <numerusform>Folyamatban: %n bójából {done}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>What is left is being planned …</source>
            <translation>A maradék tervezése folyik …</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>When a robot is lost or a cone fails, plan what is left and send it by itself</source>
            <translation>Ha egy robot elveszik vagy egy bója nem sikerül, megtervezi a maradékot, és magától elküldi</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>robots come too near to one another at %n places</source>
            <translation>
                <numerusform>a robotok %n helyen túl közel kerülnek egymáshoz</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_dock.py" />
            <source>try failed cones again</source>
            <translation>sikertelen bóják újra</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>; {queued} are in queues already</source>
            <translation>; {queued} már várólistán van</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>A plan is being made. Wait for it, or press Cancel.</source>
            <translation>Tervkészítés folyik. Várja meg, vagy nyomja meg a Mégse gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Change of the cone plan</source>
            <translation>A bójaterv módosítása</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Collecting cannot be planned: {error}</source>
            <translation>A begyűjtés nem tervezhető: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of layout {layout} stands that could be collected{also}.</source>
            <translation>A(z) {layout} elrendezésnek nincs begyűjthető bójája{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone of this plan stands that could be collected: none was placed, or they are collected or in queues already. For others choose a layout, or everything.</source>
            <translation>A tervnek nincs álló bójája, amelyet be lehetne gyűjteni: egyet sem raktak le, vagy már begyűjtötték, vagy várólistán vannak. Másokhoz válasszon elrendezést vagy mindent.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No cone stands that could be collected{also}.</source>
            <translation>Nincs begyűjthető bója{also}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>No robot that is there is chosen: tick robots in the table, or connect some.</source>
            <translation>Nincs kiválasztva jelen lévő robot: jelöljön be robotokat a táblázatban, vagy kapcsoljon be néhányat.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Others take no part in the plan.</source>
            <translation>A többi nem vesz részt a tervben.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>Preview of the cone plan</source>
            <translation>A bójaterv előnézete</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>There is no store where robots load or unload cones: choose a layer of points under Stores, or write under Aboard how many cones each robot has to place.</source>
            <translation>Nincs raktár, ahol a robotok bóját vesznek fel vagy raknak le: válasszon pontréteget a Raktárak alatt, vagy írja a Rajta oszlopba, hány kihelyezendő bója van az egyes robotokon.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_editor.py" />
            <source>What is to be collected</source>
            <translation>Mit kell begyűjteni</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>No layer of cones is chosen. Choose one, or place a cone layout first.</source>
            <translation>Nincs kiválasztva bójaréteg. Válasszon egyet, vagy előbb helyezzen el bójaelrendezést.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer of stores is not in the project any more. Choose another, or none.</source>
            <translation>A raktárak rétege már nincs a projektben. Válasszon másikat, vagy egyiket se.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>The layer {layer} has {which}: there is nothing to be placed.</source>
            <translation>A(z) {layer} rétegben {which}: nincs mit kihelyezni.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no features</source>
            <translation>nincs eleme</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_settings.py" />
            <source>no selected features</source>
            <translation>nincs kijelölt eleme</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>%n robots</source>
            <translation>
                <numerusform>%n robot</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>%n tasks that wait in the queue of {id} are replaced</source>
            <translation>
                <numerusform>{id} várólistáján %n várakozó feladat lesz lecserélve</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>FAILED</source>
            <translation>SIKERTELEN</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Found by: {method}. Ways along: {travel}.</source>
            <translation>Módszer: {method}. Az utak ezek mentén vezetnek: {travel}.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>Mind:</source>
            <translation>Figyelem:</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The queue of {robot} stays paused ({reason}): its cones wait until it is resumed.</source>
            <translation>{robot} várólistája szünetel ({reason}): bójái várnak, amíg nem folytatódik.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>The robots set off at once.</source>
            <translation>A robotok azonnal elindulnak.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>cone {cone} failed{why}</source>
            <translation>{cone} bója sikertelen{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>in the queue</source>
            <translation>a várólistán</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>it is not known where {id} is</source>
            <translation>nem ismert, hol van {id}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>no reason</source>
            <translation>nincs ok</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>straight lines</source>
            <translation>egyenes vonalak</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>taken out</source>
            <translation>kivéve</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the queue of {id} is paused ({reason}): it is resumed</source>
            <translation>{id} várólistája szünetel ({reason}): folytatódni fog</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the roads</source>
            <translation>az utak</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>the way of {robot} to {stop} leads along a closed road{why}</source>
            <translation>{robot} útja ide: {stop}, lezárt úton vezet{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>under way</source>
            <translation>folyamatban</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{by}, {time}: {robots}</source>
            <translation>{by}, {time}: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{cones}, {robots}, {metres:.0f} m, done after {span} ({method}, along {travel})</source>
            <translation>{cones}, {robots}, {metres:.0f} m, kész {span} után ({method}, {travel} mentén)</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} finishes first what it is doing</source>
            <translation>{id} előbb befejezi, amit csinál</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {away:.1f} m from where the plan begins: better plan anew</source>
            <translation>{id} {away:.1f} m-re van onnan, ahol a terv kezdődik: jobb újratervezni</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{id} is {state}: it gets its queue when it is heard of again</source>
            <translation>{id} állapota {state}: a várólistáját akkor kapja meg, ha újra hallani róla</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{robot} is lost or offline</source>
            <translation>{robot} elveszett vagy offline</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_texts.py" />
            <source>{text}. Left out: {names}</source>
            <translation>{text}. Kimaradt: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Arrives</source>
            <translation>Érkezik</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, stops</source>
            <translation>Bójaterv, megállók</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cone plan, ways</source>
            <translation>Bójaterv, utak</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Cones as placed</source>
            <translation>Kihelyezett bóják helye</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Drag a cone to another place or robot; Alt+Up and Alt+Down move it, Del takes it out</source>
            <translation>Húzza a bóját más helyre vagy robothoz; Alt+Fel és Alt+Le mozgatja, a Del kiveszi</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Give to {name}</source>
            <translation>Átadás ennek: {name}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>LOST, {text}</source>
            <translation>ELVESZETT, {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Robot, stop</source>
            <translation>Robot, megálló</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>Take out</source>
            <translation>Kivétel</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>collect </source>
            <translation>begyűjtés: </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>end at </source>
            <translation>vége itt: </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/plan_views.py" />
            <source>store </source>
            <translation>tároló: </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/planning/plan_views.py" />
            <source>{done} of %n cones</source>
            <translation>
                <numerusform>%n bójából {done}</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The assignment was cancelled.</source>
            <translation>A kiosztást megszakították.</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>The plan could not be made. Please report this:
{traceback}</source>
            <translation>A tervet nem sikerült elkészíteni. Kérjük, jelentse ezt:
{traceback}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>the way of {robot} to {stop} leads along a road that {by} closed{why}</source>
            <translation>{robot} útja ide: {stop} olyan úton vezet, amelyet {by} lezárt{why}</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{name}, straight within {nearby:g} m</source>
            <translation>{name}, {nearby:g} m-en belül egyenesen</translation>
        </message>
        <message>
            <location filename="../../plugin/planning/proposal.py" />
            <source>{robot} and {other} come within {metres:.1f} m at {x:.0f}, {y:.0f} m after {minutes}:{seconds:02d}</source>
            <translation>{robot} és {other} {metres:.1f} m-re közelítik meg egymást itt: {x:.0f}, {y:.0f} m, {minutes}:{seconds:02d} után</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>%n features have no planned or no placed position; they are left out.</source>
            <translation>
                <numerusform>%n elemnek nincs tervezett vagy kihelyezett helyzete; kimarad.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>95 % deviate at most [m]</source>
            <translation>95 % eltérése legfeljebb [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>&lt;p&gt;Compares where cones stand with where they were to stand, and writes a PDF: how many are within the tolerance, a histogram of the deviations, a map and a table of every cone, worst first.&lt;/p&gt; &lt;p&gt;The cones are a layer of the GeoPackage that &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt; writes, or its CSV; for a CSV, which has none, give the site's CRS. A cone stands where the robot was when it had reached its target, and from there the site's cone offset: the gateway's knowledge, no survey.&lt;/p&gt; &lt;p&gt;On the map a cross is the plan and a circle the cone, red where it is beyond the tolerance. Deviations are small: the lines from the crosses are longer than they are by the factor that the map names. Give background layers, such as roads, to be drawn beneath.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Összeveti, hol állnak a bóják és hol kellett volna állniuk, és PDF-et ír: hány van a tűrésen belül, az eltérések hisztogramja, térkép és táblázat minden bójáról, a legrosszabbtól kezdve.&lt;/p&gt; &lt;p&gt;A bóják a &lt;i&gt;robot-bridge placements export cones.gpkg --site site&lt;/i&gt; által írt GeoPackage egyik rétege vagy a CSV-je; CSV-hez, amelynek nincs vetülete, adja meg a telephelyét. A bója ott áll, ahol a robot volt, amikor elérte a célját, és onnan a telephely bójaeltolása: ezt tudja az átjáró, ez nem felmérés.&lt;/p&gt; &lt;p&gt;A térképen a kereszt a terv, a kör a bója, piros, ha a tűrésen túl van. Az eltérések kicsik: a keresztekből induló vonalak annyiszor hosszabbak náluk, amennyit a térkép kiír. Adjon meg háttérrétegeket, például utakat, amelyek alájuk rajzolódnak.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:asplacedreport -- INPUT="cones.gpkg|layername=placed" TOLERANCE=0.2 OUTPUT=report.pdf&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Background of the map</source>
            <translation>A térkép háttere</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones as placed and as planned</source>
            <translation>Bóják kihelyezve és tervezve</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Cones within the tolerance</source>
            <translation>A tűrésen belüli bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>It is written: {link}</source>
            <translation>Elkészült: {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Largest deviation [m]</source>
            <translation>Legnagyobb eltérés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Mean deviation [m]</source>
            <translation>Átlagos eltérés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>PDF files (*.pdf)</source>
            <translation>PDF-fájlok (*.pdf)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Pages</source>
            <translation>Oldalak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Records</source>
            <translation>Feljegyzések</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Report</source>
            <translation>Jelentés</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Root mean square deviation [m]</source>
            <translation>Négyzetes középeltérés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Site CRS (default: the layer's)</source>
            <translation>A telephely vetülete (alapértelmezés: a rétegé)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>The CRS of the placed cones is not known, as of a CSV: give CRS, the site's, such as EPSG:32633.</source>
            <translation>A kihelyezett bóják vetülete nem ismert, mint a CSV esetén: adja meg a CRS paramétert, a telephelyét, például EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Title</source>
            <translation>Cím</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Tolerance [m]</source>
            <translation>Tűrés [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Warnings</source>
            <translation>Figyelmeztetések</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>Writes a PDF of how placed cones stand against their plan: figures, histogram, map and table.</source>
            <translation>PDF-et ír arról, hogyan állnak a kihelyezett bóják a tervhez képest: számok, hisztogram, térkép és táblázat.</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/as_placed_report.py" />
            <source>{within} of %n cones are within {tolerance:g} m; the worst is {most:.3f} m off.</source>
            <translation>
                <numerusform>%n bójából {within} van {tolerance:g} m-en belül; a legrosszabb {most:.3f} m-rel tér el.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>%n trips</source>
            <translation>
                <numerusform>%n kör</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>&lt;p&gt;Shares &lt;b&gt;cones&lt;/b&gt; out among &lt;b&gt;robots&lt;/b&gt;. Robots load cones to place, and unload collected ones, at &lt;b&gt;stores&lt;/b&gt;, as often as their capacity asks for. Distances are those of the &lt;b&gt;roads&lt;/b&gt;; without roads they are straight lines, and the log says so.&lt;/p&gt; &lt;p&gt;Fields that layers may have, with the parameters as defaults: cones &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place or collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robots &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; stores &lt;i&gt;id, service_s&lt;/i&gt;. Every cone of a lower &lt;b&gt;stage&lt;/b&gt; is done before one of a higher stage is begun.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Objective&lt;/b&gt;: &lt;i&gt;balanced&lt;/i&gt; has the last robot finish as early as possible, &lt;i&gt;distance&lt;/i&gt; drives the fewest metres in all. &lt;b&gt;Method&lt;/b&gt;: &lt;i&gt;pyvrp&lt;/i&gt; works until the time limit is over, &lt;i&gt;preview&lt;/i&gt; is quick; &lt;i&gt;automatic&lt;/i&gt; takes pyvrp where Python has it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Targets&lt;/b&gt; are the stops of each robot in order with their times, &lt;b&gt;paths&lt;/b&gt; the ways between them, &lt;b&gt;plan&lt;/b&gt; is all of it as JSON. A cone that cannot be served is named, and nothing is written.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</source>
            <translation>&lt;p&gt;&lt;b&gt;Bójákat&lt;/b&gt; oszt szét &lt;b&gt;robotok&lt;/b&gt; között. A robotok a &lt;b&gt;tárolókban&lt;/b&gt; veszik fel a kihelyezendő és adják le a begyűjtött bójákat, ahányszor a befogadóképességük kívánja. A távolságok az &lt;b&gt;utakon&lt;/b&gt; értendők; utak nélkül légvonalban, és a napló ezt megmondja.&lt;/p&gt; &lt;p&gt;Mezők, amelyek a rétegekben lehetnek, alapértékük a paraméter: bóják &lt;i&gt;id, heading, stage, task&lt;/i&gt; (place vagy collect), &lt;i&gt;demand, service_s&lt;/i&gt;; robotok &lt;i&gt;id, capacity, speed, range_m, aboard, collected, ready_s&lt;/i&gt;; tárolók &lt;i&gt;id, service_s&lt;/i&gt;. Egy alacsonyabb &lt;b&gt;szakasz&lt;/b&gt; (stage) minden bójája elkészül, mielőtt egy magasabbé elkezdődik.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Célfüggvény&lt;/b&gt;: a &lt;i&gt;balanced&lt;/i&gt; esetén az utolsó robot a lehető leghamarabb végez, a &lt;i&gt;distance&lt;/i&gt; összesen a legkevesebb métert teszi meg. &lt;b&gt;Módszer&lt;/b&gt;: a &lt;i&gt;pyvrp&lt;/i&gt; az időkorlát végéig dolgozik, a &lt;i&gt;preview&lt;/i&gt; gyors; az &lt;i&gt;automatic&lt;/i&gt; a pyvrp-t veszi, ahol a Pythonban megvan.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;célok&lt;/b&gt; az egyes robotok megállói sorrendben, időkkel, a &lt;b&gt;pályák&lt;/b&gt; a köztük lévő utak, a &lt;b&gt;terv&lt;/b&gt; mindez JSON-ként. A kiszolgálhatatlan bóját megnevezi, és semmi sem íródik ki.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Assign cones to robots</source>
            <translation>Bóják kiosztása robotoknak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>CONES holds no cone: there is nothing to plan.</source>
            <translation>CONES nem tartalmaz bóját: nincs mit tervezni.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Cones that a robot carries (default of field capacity)</source>
            <translation>Bóják, amennyit egy robot visz (alapértelmezése a capacity mezőnek)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Field of the stage: cones of lower ones come first</source>
            <translation>A szakasz mezője: az alacsonyabb bóják jönnek előbb</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>JSON (*.json)</source>
            <translation>JSON (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method</source>
            <translation>Módszer</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Method that was used</source>
            <translation>Használt módszer</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres of all robots</source>
            <translation>Az összes robot méterei</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Metres that a robot's battery lasts, 0 for any (default of field range_m)</source>
            <translation>Ahány méterre elég a robot akkumulátora, 0: bármennyire (alapértelmezése a range_m mezőnek)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>No roads are given: distances and paths are straight lines.</source>
            <translation>Nincsenek megadva utak: a távolságok és pályák egyenes vonalak.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Objective</source>
            <translation>Célfüggvény</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Paths</source>
            <translation>Pályák</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Planned by {method} along {travel}: the last robot is done after {end_s:.0f} s, {metres:.0f} m in all</source>
            <translation>Tervezés: {method}, ezek mentén: {travel}; az utolsó robot {end_s:.0f} s múlva végez, összesen {metres:.0f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Plans which robot places or collects which cone, on which trip, along which roads, and when.</source>
            <translation>Megtervezi, melyik robot melyik bóját helyezi ki vagy gyűjti be, melyik körben, mely utakon és mikor.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Road centrelines (default: straight lines)</source>
            <translation>Úttengelyek (alapértelmezés: egyenes vonalak)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robot {id}: {cones} on {trips}, {metres:.0f} m, done after {end_s:.0f} s</source>
            <translation>{id} robot: {cones}, {trips}, {metres:.0f} m, {end_s:.0f} s múlva végez</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots that drive</source>
            <translation>Robotok, amelyek mennek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Robots, where they are</source>
            <translation>Robotok, ahol vannak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds of a visit to a store (default of its field service_s)</source>
            <translation>Egy raktári megállás másodpercei (alapértelmezése a service_s mezőnek)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds to place or collect a cone (default of field service_s)</source>
            <translation>Bója kihelyezése vagy begyűjtése [s] (a service_s mező alapértéke)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last cone is done</source>
            <translation>Másodpercek, amíg az utolsó bója kész</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Seconds until the last robot has finished</source>
            <translation>Másodpercek, amíg az utolsó robot végez</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Speed of a robot [m/s] (default of field speed)</source>
            <translation>A robot sebessége [m/s] (alapértelmezése a speed mezőnek)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Stores of cones</source>
            <translation>Bójaraktárak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Targets</source>
            <translation>Célok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The CRS of the cones is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>A bóják vetülete nem ismert: adja meg a SITE_CRS-t, például EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan</source>
            <translation>A terv</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>The plan cannot be driven: {faults}. Please report this.</source>
            <translation>A terv nem járható be: {faults}. Kérjük, jelentse ezt.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Time limit [s]</source>
            <translation>Időkorlát [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Trips</source>
            <translation>Körök</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What is done with cones (default of field task)</source>
            <translation>Mi történik a bójákkal (alapértelmezése a task mezőnek)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>What the ways follow</source>
            <translation>Amit az utak követnek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>Where robots go at the end</source>
            <translation>Hová mennek a robotok a végén</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/assign_cones.py" />
            <source>{name} {given} cannot be opened: check the file and the layer's name.</source>
            <translation>{name}: {given} nem nyitható meg: ellenőrizze a fájlt és a réteg nevét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Places a layout of traffic cones, either at a &lt;b&gt;point&lt;/b&gt;, turned to a &lt;b&gt;heading&lt;/b&gt; (degrees clockwise from north), or along a &lt;b&gt;line&lt;/b&gt; such as a road's centreline, from &lt;b&gt;start&lt;/b&gt; metres after its beginning. The layer has an id, the order of placing, the heading of travel, the colour and the role of each cone.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Dimensions&lt;/b&gt; change the standard's: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. The log lists those of the layout with their values. A wrong name or value is refused with what there is.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt;: on one of the surfaces (of the allowed classes), away from obstacles and from other cones. What is wrong becomes a layer of findings with the cone's id and the reason; the cones are placed nevertheless.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Forgalomterelő bóják elrendezését helyezi el, vagy egy &lt;b&gt;ponton&lt;/b&gt;, adott &lt;b&gt;irányba&lt;/b&gt; fordítva (fok, északtól az óramutató járása szerint), vagy egy &lt;b&gt;vonal&lt;/b&gt;, például úttengely mentén, annak elejétől a &lt;b&gt;start&lt;/b&gt; méternyire. A rétegben minden bójának azonosítója, kihelyezési sorszáma, haladási iránya, színe és szerepe van.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;méretek&lt;/b&gt; a szabványéit változtatják: &lt;code&gt;vehicle_width=1.7; lane_offset=3&lt;/code&gt;. A napló felsorolja az elrendezés méreteit értékeikkel. A rossz nevet vagy értéket visszautasítja, és megmondja, mi van.&lt;/p&gt; &lt;p&gt;Minden bóját &lt;b&gt;ellenőriz&lt;/b&gt;: valamelyik felületen van-e (a megengedett osztályokból), távol akadályoktól és más bójáktól. Ami nem jó, a leletek rétegébe kerül a bója azonosítójával és az okkal; a bóják ettől még elhelyeződnek.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]" HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>&lt;p&gt;Reads cones from a &lt;b&gt;CSV file&lt;/b&gt; in UTF-8, from a &lt;b&gt;track&lt;/b&gt; of Formula Student, or from a &lt;b&gt;layer&lt;/b&gt;. Tracks are YAML with &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; and &lt;i&gt;cones_orange_big&lt;/i&gt;, SDF with models of cones, CSV with columns such as &lt;i&gt;blue_x&lt;/i&gt; and &lt;i&gt;blue_y&lt;/i&gt; for each colour, or CSV without a head line: colour, x, y. Of other tables the columns are named by parameters; only those of x and y are needed, and not even those for a layer of points with a CRS, which is taken as it lies. A file or layer with several layouts gives one of them, by &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; and &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Metres of a table are turned by &lt;b&gt;rotation&lt;/b&gt; (degrees, counter-clockwise) and then moved to the &lt;b&gt;origin&lt;/b&gt;. A row that cannot be read is named with its column, and nothing is placed.&lt;/p&gt; &lt;p&gt;Every cone is &lt;b&gt;checked&lt;/b&gt; as those of &lt;i&gt;Cone layout&lt;/i&gt; are.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Bójákat olvas UTF-8 kódolású &lt;b&gt;CSV-fájlból&lt;/b&gt;, Formula Student &lt;b&gt;pályából&lt;/b&gt; vagy &lt;b&gt;rétegből&lt;/b&gt;. A pálya YAML &lt;i&gt;cones_left&lt;/i&gt;, &lt;i&gt;cones_right&lt;/i&gt;, &lt;i&gt;cones_orange&lt;/i&gt; és &lt;i&gt;cones_orange_big&lt;/i&gt; kulcsokkal, SDF bójamodellekkel, CSV színenként két oszloppal, mint &lt;i&gt;blue_x&lt;/i&gt; és &lt;i&gt;blue_y&lt;/i&gt;, vagy fejléc nélküli CSV: szín, x, y. Más táblázatok oszlopait paraméterek nevezik meg; csak az x és az y kell, és azok sem, ha vetülettel bíró pontrétegről van szó, amely úgy marad, ahogy fekszik. Több elrendezést tartalmazó fájlból vagy rétegből egyet ad a &lt;b&gt;LAYOUT_FIELD&lt;/b&gt; és a &lt;b&gt;LAYOUT&lt;/b&gt;.&lt;/p&gt; &lt;p&gt;Egy táblázat métereit a &lt;b&gt;rotation&lt;/b&gt; (fok, az óramutatóval ellentétesen) elforgatja, majd a &lt;b&gt;kezdőpontba&lt;/b&gt; tolja. Az olvashatatlan sort oszlopával együtt megnevezi, és semmi sem helyeződik el.&lt;/p&gt; &lt;p&gt;Minden bóját &lt;b&gt;ellenőriz&lt;/b&gt;, ahogy a &lt;i&gt;Bójaelrendezés&lt;/i&gt; teszi.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90 SITE_CRS=EPSG:32633 CONES=cones.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Against the direction of the line</source>
            <translation>A vonal irányával szemben</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Begin so far along the line [m]</source>
            <translation>Kezdés a vonal mentén ennyire [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both FILE and INPUT are</source>
            <translation>FILE és INPUT is meg van adva</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Both POINT and LINE are</source>
            <translation>POINT és LINE is meg van adva</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>CSV file, or track of Formula Student (YAML, SDF)</source>
            <translation>CSV-fájl vagy Formula Student pálya (YAML, SDF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of colours</source>
            <translation>A színek oszlopa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of headings, clockwise from the y axis [degrees]</source>
            <translation>Az irányok oszlopa, az y tengelytől az óramutató járásával [fok]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of ids</source>
            <translation>Az azonosítók oszlopa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of roles</source>
            <translation>A szerepek oszlopa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of the order of placing</source>
            <translation>A kihelyezési sorrend oszlopa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of x [m]</source>
            <translation>x oszlopa [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column of y [m]</source>
            <translation>y oszlopa [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Column that names the layout of each row</source>
            <translation>A sorok elrendezésének oszlopa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layout</source>
            <translation>Bójaelrendezés</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Cone layouts ({kinds});;All files (*)</source>
            <translation>Bójaelrendezések ({kinds});;Minden fájl (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>DIMENSIONS has {part!r}, which is not name=value with a number: write such as spacing=15.</source>
            <translation>A DIMENSIONS része {part!r}, ami nem név=érték számmal: írja így: spacing=15.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Dimensions other than the standard's, as name=value; ...</source>
            <translation>A szabványostól eltérő méretek, név=érték; ... alakban</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>FILE {file} is none that is read: give one of {kinds}.</source>
            <translation>FILE: a(z) {file} fájlfajta nem olvasható: adjon meg ilyet: {kinds}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Heading, clockwise from north [degrees]</source>
            <translation>Irány, északtól az óramutató járásával [fok]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Id of the line's feature (default: the only one)</source>
            <translation>A vonal elemének azonosítója (alapértelmezés: az egyetlen)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Ids begin with (default: the layout)</source>
            <translation>Az azonosítók eleje (alapértelmezés: az elrendezés)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Import cone layout</source>
            <translation>Bójaelrendezés importálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layer, instead of a file</source>
            <translation>Réteg, fájl helyett</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Layout</source>
            <translation>Elrendezés</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Line to lie along, instead of a place</source>
            <translation>Vonal, amely mentén fekszik, hely helyett</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Name (default: the layout's, else the file's)</source>
            <translation>Név (alapértelmezés: az elrendezésé, különben a fájlé)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither FILE nor INPUT is</source>
            <translation>Sem FILE, sem INPUT nincs megadva</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Neither POINT nor LINE is</source>
            <translation>Sem POINT, sem LINE nincs megadva</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>ORIGIN is not given: say where the table's 0,0 goes.</source>
            <translation>ORIGIN nincs megadva: mondja meg, hová kerül a táblázat 0,0 pontja.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Place of the layout's origin</source>
            <translation>Az elrendezés kezdőpontjának helye</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places a standard cone layout at a point and heading or along a line, and checks every cone.</source>
            <translation>Szabványos bójaelrendezést helyez egy pontra és irányba vagy egy vonal mentén, és minden bóját ellenőriz.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Places the cones of a CSV file or a layer, turned and moved to their place, and checks them.</source>
            <translation>Egy CSV-fájl vagy réteg bójáit helyére forgatja és tolja, és ellenőrzi őket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Rotation, counter-clockwise [degrees]</source>
            <translation>Elforgatás, az óramutató járásával ellentétesen [fok]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {layer} has no line with a length and a place in the site's CRS: correct it, or choose another.</source>
            <translation>A(z) {layer} {id}. elemének nincs olyan vonala, amelynek hossza és a telephely vetületében helye van: javítsa ki, vagy válasszon másikat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The feature {id} of {sourcename} has {lines} lines: split it, or choose one that has one.</source>
            <translation>A(z) {sourcename} {id}. eleme {lines} vonalból áll: ossza fel, vagy válasszon olyat, amely egyből áll.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The layer {sourcename} has {found}: choose one line by LINE_ID, or select it and tick 'Selected features only'.</source>
            <translation>A(z) {sourcename} réteg: {found}. Válasszon egy vonalat a LINE_ID-vel, vagy jelölje ki, és kapcsolja be: „Csak a kijelölt elemek”.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>The one layout to take, by that column</source>
            <translation>Az egyetlen átveendő elrendezés, ezen oszlop szerint</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>Where the table's 0,0 goes</source>
            <translation>Hová kerül a táblázat 0,0 pontja</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>no feature {wanted}</source>
            <translation>nincs benne {wanted}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>not exactly one feature</source>
            <translation>nem pontosan egy elem van benne</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give a CSV file, or a layer.</source>
            <translation>{how}: adjon meg egy CSV-fájlt vagy egy réteget.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/cone_layouts.py" />
            <source>{how} given: give the place of the layout, or a line that it lies along.</source>
            <translation>{how}: adja meg az elrendezés helyét, vagy egy vonalat, amely mentén fekszik.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>&lt;p&gt;Writes a robot map as other robots and people read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robot map&lt;/b&gt;: a file of &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; or of the gateway, text or binary.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: occupancy grid for Nav2 (PGM and YAML). What a wall touches is occupied, so thin walls have no gap; courtyards are free; the inside of obstacles is unknown, or occupied on request. The frame of the grid is the site frame.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: mask for Nav2's keepout filter, from the keepout layer, with the filter's parameters.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: mask for Nav2's speed filter, from the speed layer and its expression in m/s. A limit is never rounded up; where areas overlap the lower one holds.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: obstacles and segments in WGS 84 (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: the same in the site's CRS.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: a picture for people.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;&lt;b&gt;Keepout and speed layers&lt;/b&gt; are polygons in any CRS. Where the map's place is not known, layers are taken to be in its own metres, and a warning says so; &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; give it one.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robots drive over&lt;/b&gt; obstacles that are lower: 0 keeps every kerb. Ramps are always driven on, stairs are obstacles, also from the side.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;p&gt;From a script, with no display:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Robottérképet ír ki úgy, ahogy más robotok és emberek olvassák.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Robottérkép&lt;/b&gt;: a &lt;i&gt;fleet:exportrobotmap&lt;/i&gt; vagy az átjáró szöveges vagy bináris fájlja.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formátumok&lt;/b&gt;, egyszerre több is:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;occupancy&lt;/i&gt;: foglaltsági rács a Nav2-nek (PGM és YAML). Amit egy fal érint, foglalt, így a vékony falaknak nincs résük; az udvarok szabadok; az akadályok belseje ismeretlen, kérésre foglalt. A rács kerete a telephelyi keret.&lt;/li&gt; &lt;li&gt;&lt;i&gt;keepout&lt;/i&gt;: maszk a Nav2 keepout szűrőjéhez a tiltott területek rétegéből, a szűrő paramétereivel.&lt;/li&gt; &lt;li&gt;&lt;i&gt;speed&lt;/i&gt;: maszk a Nav2 speed szűrőjéhez a sebességrétegből és m/s-ban adott kifejezéséből. A korlát sosem kerekedik felfelé; ahol területek fedik egymást, az alacsonyabb érvényes.&lt;/li&gt; &lt;li&gt;&lt;i&gt;geojson&lt;/i&gt;: akadályok és szakaszok WGS 84-ben (RFC 7946).&lt;/li&gt; &lt;li&gt;&lt;i&gt;geopackage&lt;/i&gt;: ugyanaz a telephely vetületében.&lt;/li&gt; &lt;li&gt;&lt;i&gt;svg&lt;/i&gt;, &lt;i&gt;png&lt;/i&gt;: kép embereknek.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;A &lt;b&gt;tiltott és sebességrétegek&lt;/b&gt; poligonok, bármilyen vetületben. Ahol a térkép helye nem ismert, a rétegek a térkép saját métereiben értendők, és figyelmeztetés szól erről; a &lt;i&gt;SITE_CRS&lt;/i&gt;, az &lt;i&gt;ORIGIN&lt;/i&gt; és a &lt;i&gt;ROTATION&lt;/i&gt; helyet ad neki.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;robotok áthajtanak&lt;/b&gt; az ennél alacsonyabb akadályokon: 0 minden szegélyt megtart. A rámpákon mindig lehet hajtani, a lépcsők akadályok, oldalról is.&lt;/p&gt; &lt;p&gt;A meglévő fájlokat lecseréli, mindegyiket egy lépésben, miután mind elkészült. Hogy mi van bennük, a docs/navigation-maps.md írja le.&lt;/p&gt; &lt;p&gt;Szkriptből, kijelző nélkül:&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportnavigationmap -- MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Areas with a speed limit</source>
            <translation>Sebességkorlátozott területek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Export navigation map</source>
            <translation>Navigációs térkép exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS has {format}, which needs {name}: give it, or leave {format} out.</source>
            <translation>A FORMATS-ban {format} szerepel, amelyhez {name} kell: adja meg, vagy hagyja el: {format}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>FORMATS is {formats}: choose of {known}.</source>
            <translation>FORMATS értéke {formats}: válasszon ezekből: {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>File of format {name}</source>
            <translation>{name} formátumú fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Files</source>
            <translation>Fájlok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Formats</source>
            <translation>Formátumok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Inside of obstacles in the occupancy grid</source>
            <translation>Az akadályok belseje a foglaltsági rácson</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Keepout areas</source>
            <translation>Tiltott területek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Making {format}</source>
            <translation>{format} készítése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>NAME {name!r} is no file's name: leave out folders and leading dots.</source>
            <translation>A NAME értéke, {name!r}, nem fájlnév: hagyja el a mappákat és a kezdő pontokat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Name of the files (default: the robot map's)</source>
            <translation>A fájlok neve (alapértelmezés: a robottérképé)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 keepout mask</source>
            <translation>Nav2 tiltottterület-maszk</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 occupancy grid</source>
            <translation>Nav2 foglaltsági rács</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Nav2 speed mask</source>
            <translation>Nav2 sebességmaszk</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Robots drive over what is lower than [m]</source>
            <translation>A robotok áthajtanak azon, ami ennél alacsonyabb [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Side of a cell of grid and masks [m]</source>
            <translation>A rács és a maszkok cellájának oldala [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Speed limit of each area [m/s]</source>
            <translation>Az egyes területek sebességkorlátja [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The coordinates of the keepout and speed layers are taken as the map's own metres.</source>
            <translation>A tiltott és sebességkorlátozott rétegek koordinátái a térkép saját métereiként értendők.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>The navigation map</source>
            <translation>A navigációs térkép</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>Writes a robot map as Nav2 occupancy grid and masks, GeoJSON, GeoPackage, SVG or PNG.</source>
            <translation>Robottérképet ír ki Nav2 foglaltsági rácsként és maszkokként, GeoJSON, GeoPackage, SVG vagy PNG alakban.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>above 0, such as 0.05</source>
            <translation>0-nál nagyobb, például 0.05</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>empty</source>
            <translation>üres</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>occupied</source>
            <translation>foglalt</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>of 0 or more</source>
            <translation>0 vagy nagyobb</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>unknown</source>
            <translation>ismeretlen</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{name} is {value}: give a number of metres {wanted}.</source>
            <translation>{name} értéke {value}: adjon meg méterben egy számot, amely {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{parameter} {layer} cannot be opened: check the file and the layer's name.</source>
            <translation>{parameter}: {layer} nem nyitható meg: ellenőrizze a fájlt és a réteg nevét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{target} is the robot map itself: choose another NAME or OUTPUT.</source>
            <translation>{target} maga a robottérkép: válasszon másik NAME vagy OUTPUT értéket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_navigation_map.py" />
            <source>{target}: {content} bytes</source>
            <translation>{target}: {content} bájt</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>%n edges</source>
            <translation>
                <numerusform>%n él</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>&lt;p&gt;Writes the network of road centrelines as other robots read it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formats&lt;/b&gt;, several at once:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: graph for Nav2's route server (GeoJSON). Nav2 drives straight from node to node, so every point of a road becomes a node.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: VDMA's Layout Interchange Format 1.0, for masters of VDA 5050 vehicles (JSON). Roads that are not straight have a trajectory.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: lanes with borders for Lanelet2 and Autoware (OSM). Traffic keeps to the right, or to the left on request.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;Roads that are driven both ways become two edges; one-way roads one. Closed roads are left out, and so are edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt;. Speeds go over as limits.&lt;/p&gt; &lt;p&gt;Coordinates are metres in the &lt;b&gt;site frame&lt;/b&gt;, as on robot maps: &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt;, else as the project has it. Nav2 keeps 32 bits of a coordinate: give an origin on the site, or a warning says by how much places move.&lt;/p&gt; &lt;p&gt;Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md says what is in each.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Az úttengelyek hálózatát írja ki úgy, ahogy más robotok olvassák.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formátumok&lt;/b&gt;, egyszerre több is:&lt;/p&gt; &lt;ul&gt; &lt;li&gt;&lt;i&gt;nav2&lt;/i&gt;: gráf a Nav2 útvonalszerverének (GeoJSON). A Nav2 egyenesen hajt csomóponttól csomópontig, ezért egy út minden pontja csomópont lesz.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lif&lt;/i&gt;: a VDMA Layout Interchange Format 1.0 formátuma, VDA 5050 járművek irányítóinak (JSON). A nem egyenes utaknak pályagörbéjük van.&lt;/li&gt; &lt;li&gt;&lt;i&gt;lanelet2&lt;/i&gt;: sávok széleikkel a Lanelet2-nek és az Autoware-nek (OSM). A forgalom jobbra tart, kérésre balra.&lt;/li&gt; &lt;/ul&gt; &lt;p&gt;A mindkét irányban járható utakból két él lesz, az egyirányúakból egy. A lezárt utak kimaradnak, és azok az élek is, amelyek a &lt;b&gt;területek, amelyeken nem szabad áthajtani&lt;/b&gt; egy poligonján vezetnek át. A sebességek korlátként mennek át.&lt;/p&gt; &lt;p&gt;A koordináták méterek a &lt;b&gt;telephelyi keretben&lt;/b&gt;, mint a robottérképeken: &lt;i&gt;ORIGIN&lt;/i&gt; és &lt;i&gt;ROTATION&lt;/i&gt;, különben ahogy a projekté. A Nav2 egy koordinátából 32 bitet tart meg: adjon meg kezdőpontot a telephelyen, különben figyelmeztetés mondja meg, mennyivel mozdulnak el a helyek.&lt;/p&gt; &lt;p&gt;A meglévő fájlokat lecseréli, mindegyiket egy lépésben, miután mind elkészült. Hogy mi van bennük, a docs/navigation-maps.md írja le.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Edges</source>
            <translation>Élek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Export road network</source>
            <translation>Úthálózat exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>FORMATS is empty: choose of {known}.</source>
            <translation>A FORMATS üres: válasszon ezekből: {known}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 map (OSM)</source>
            <translation>Lanelet2-térkép (OSM)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 needs longitudes and latitudes, and the CRS of the roads has no place on the Earth: give the layer its CRS, or leave lanelet2 out.</source>
            <translation>A Lanelet2-höz hosszúságok és szélességek kellenek, és az utak vetületének nincs helye a Földön: adja meg a réteg vetületét, vagy hagyja el a lanelet2-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Lanelet2 reads lanes the wrong way round where corners are tighter than lanes are wide: {count} here, the first at ({x:.2f}, {y:.2f}). Draw the roads there smoother, or give them less width.</source>
            <translation>A Lanelet2 fordítva olvassa a sávokat, ahol a kanyarok szűkebbek, mint amilyen szélesek a sávok: itt {count} ilyen van, az első itt: ({x:.2f}, {y:.2f}). Rajzolja ott simábbra az utakat, vagy adjon nekik kisebb szélességet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Name of the files</source>
            <translation>A fájlok neve</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 keeps 32 bits of a coordinate, which here moves nodes by up to {metres:.2f} m: give ORIGIN, a place of the site, for robots and their maps alike.</source>
            <translation>A Nav2 egy koordinátából 32 bitet tart meg, ami itt legfeljebb {metres:.2f} m-rel mozdítja el a csomópontokat: adja meg az ORIGIN-t, egy helyet a telephelyen, a robotoknak és térképeiknek egyaránt.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Nav2 route graph (GeoJSON)</source>
            <translation>Nav2-útvonalgráf (GeoJSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Roads</source>
            <translation>Utak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Robots' name for the site frame</source>
            <translation>A telephelyi keret neve a robotoknál</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>The road network</source>
            <translation>Az úthálózat</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Traffic keeps to the left (Lanelet2)</source>
            <translation>A forgalom balra tart (Lanelet2)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Type of vehicle that drives here (LIF)</source>
            <translation>Az itt közlekedő járművek típusa (LIF)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>VDMA LIF, for VDA 5050 (JSON)</source>
            <translation>VDMA LIF, VDA 5050-hez (JSON)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>Writes the road network as a Nav2 route graph, a VDMA LIF layout or a Lanelet2 map.</source>
            <translation>Az úthálózatot Nav2-útvonalgráfként, VDMA LIF elrendezésként vagy Lanelet2-térképként írja ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_road_network.py" />
            <source>{name} {value!r} cannot be used: give a plain word.</source>
            <translation>{name} {value!r} nem használható: adjon meg egy egyszerű szót.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>&lt;p&gt;Writes the obstacles in a window of the site as a map that robots read: oriented segments with free space to their right, grouped by kind. Robots get metres in the &lt;b&gt;site frame&lt;/b&gt;: a projected CRS, an origin in it and a rotation.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacle layers&lt;/b&gt;: lines and polygons, several at once, in any CRS. Curves become chords (2 cm). What the window cuts becomes open chains; no wall is invented on the border.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Window&lt;/b&gt;: a centre with width and height in metres, or an extent. Positions may name their CRS, as in &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; without one they are in the site CRS.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS&lt;/b&gt;: in metres, such as the local UTM zone. EPSG:3857 is refused, because its metres are not metres. Default: the project's CRS; without a project the layers' own. A local engineering CRS is used as it is.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Height, foot, label, outdoors&lt;/b&gt;: QGIS expressions; the foot is where a feature begins above the ground, and its height counts from there. What a layer keeps (menu Fleet Supervisor, Layer roles) wins over these. There its role makes flights of risers of a layer (stairs) or surfaces without height (ramp), its filter says which features count, and points of furniture get a shape. Default: the field &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, on the ground, the layer's name, true. Where no height is known, the default height is used, said in a warning and marked &lt;i&gt;h=est&lt;/i&gt; in the map.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Map profile&lt;/b&gt;: a file that says by layer name what layers are: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; or the path of one's own. It wins over what the layers keep.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Smaller maps&lt;/b&gt; (advanced, each off unless asked for): only what the robot's plane meets, without walls between or inside buildings, lines joined, fewer corners, no short segments, heights in steps. The log says how many obstacles and segments there were before and after. Walls between buildings, corners and short segments need the Python package shapely 2.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Format&lt;/b&gt;: text; binary (the text compressed, with a check sum), which needs the Python package zstandard; compact (about a third of binary, whole centimetres), which needs cbor2 instead. The file &lt;i&gt;docs/robot-map.md&lt;/i&gt; of the project describes them, and exports from a script.&lt;/p&gt; &lt;p&gt;Broken geometry is repaired where that is safe and left out where it is not. Each time a warning names the layer and the feature; the export goes on.&lt;/p&gt;</source>
            <translation>&lt;p&gt;A telephely egy ablakának akadályait olyan térképként írja ki, amelyet robotok olvasnak: irányított szakaszok, jobbjukon szabad területtel, fajták szerint csoportosítva. A robotok métereket kapnak a &lt;b&gt;telephelyi keretben&lt;/b&gt;: egy vetület, abban egy kezdőpont és egy elforgatás.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Akadályrétegek&lt;/b&gt;: vonalak és poligonok, egyszerre több is, bármilyen vetületben. Az ívekből húrok lesznek (2 cm). Amit az ablak elvág, nyílt lánc lesz; a kereten nem keletkezik fal.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Ablak&lt;/b&gt;: egy középpont szélességgel és magassággal méterben, vagy egy terjedelem. A helyek megnevezhetik vetületüket, mint &lt;i&gt;12.5,48.1 [EPSG:4326]&lt;/i&gt;; enélkül a telephely vetületében vannak.&lt;/p&gt; &lt;p&gt;&lt;b&gt;A telephely vetülete&lt;/b&gt;: méterben, például a helyi UTM-zóna. Az EPSG:3857 nem fogadható el, mert méterei nem méterek. Alapértelmezés: a projekt vetülete; projekt nélkül a rétegeké. A helyi mérnöki vetület úgy használatos, ahogy van.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Magasság, alj, címke, kültér&lt;/b&gt;: QGIS-kifejezések; az alj az, ahol egy elem a talaj felett kezdődik, és magassága onnan számít. Amit egy réteg őriz (Fleet Supervisor menü, Rétegszerepek), az előbbre való. Ott a szerepe lépcsőt (stairs) vagy magasság nélküli felületet (ramp) csinál egy rétegből, a szűrője megmondja, mely elemek számítanak, és a pontszerű berendezések alakot kapnak. Alapértelmezés: a &lt;i&gt;height&lt;/i&gt; vagy &lt;i&gt;height_m&lt;/i&gt; mező, a talajon, a réteg neve, igaz. Ahol a magasság nem ismert, az alapértelmezett magasság érvényes, figyelmeztetéssel és &lt;i&gt;h=est&lt;/i&gt; jelöléssel a térképen.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Térképprofil&lt;/b&gt;: fájl, amely rétegnév szerint megmondja, mi egy réteg: &lt;i&gt;openstreetmap&lt;/i&gt;, &lt;i&gt;upc_campus_nord&lt;/i&gt; vagy egy saját fájl útvonala. Előbbre való annál, amit a rétegek őriznek.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Kisebb térképek&lt;/b&gt; (haladó, mind ki van kapcsolva, amíg nem kérik): csak amit a robot síkja metsz, épületek közti és belső falak nélkül, összefűzött vonalakkal, kevesebb sarokkal, rövid szakaszok nélkül, lépcsőzött magasságokkal. A napló megmondja, hány akadály és szakasz volt előtte és utána. Az épületek közti falakhoz, sarkokhoz és rövid szakaszokhoz a shapely 2 Python-csomag kell.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Formátum&lt;/b&gt;: szöveg; bináris (a tömörített szöveg, ellenőrző összeggel), amelyhez a zstandard Python-csomag kell; kompakt (a bináris mintegy harmada, egész centiméterek), amelyhez ehelyett a cbor2. A projekt &lt;i&gt;docs/robot-map.md&lt;/i&gt; fájlja leírja őket és a szkriptből való exportálást.&lt;/p&gt; &lt;p&gt;A hibás geometria ki lesz javítva, ahol ez biztonságos, és kimarad, ahol nem az. Minden esetben figyelmeztetés nevezi meg a réteget és az elemet; az exportálás folytatódik.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Compactness [bytes/m²]</source>
            <translation>Tömörség [bájt/m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Export robot map</source>
            <translation>Robottérkép exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Foot of each feature above ground [m] (default: on it)</source>
            <translation>Hol kezdődik az egyes elem a talaj felett [m] (alapértelmezés: a talajon)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height of each feature [m] (default: its field height)</source>
            <translation>Az egyes elemek magassága [m] (alapértelmezés: a height mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Height where none is known, marked as estimated [m]</source>
            <translation>Magasság, ahol nem ismert, becsültként jelölve [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Label of each feature (default: the layer's name)</source>
            <translation>Az egyes elemek címkéje (alapértelmezés: a réteg neve)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map</source>
            <translation>Robottérkép</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Robot map, text (*.txt);;Robot map, binary (*.rmap)</source>
            <translation>Robottérkép, szöveg (*.txt);;Robottérkép, bináris (*.rmap)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Segments</source>
            <translation>Szakaszok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Size of the file [bytes]</source>
            <translation>A fájl mérete [bájt]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Such as "clearance" of arches, or 2.2 for signs; the height of a feature counts from there. The upper height of the robot's plane leaves out what begins above it.</source>
            <translation>Például ívek "clearance" mezője, vagy tábláknál 2.2; az elem magassága onnan számít. A robot síkjának felső magassága kihagyja, ami felette kezdődik.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window, and no layer reaches it: the layers lie from ({x_min:.0f}, {y_min:.0f}) to ({x_max:.0f}, {y_max:.0f}) in the site frame. Check the order of the window's numbers, their CRS and the site CRS. To a robot this map says that all is free.</source>
            <translation>Nincs akadály az ablakban, és egyetlen réteg sem ér el odáig: a rétegek a telephelyi keretben ({x_min:.0f}, {y_min:.0f}) és ({x_max:.0f}, {y_max:.0f}) között vannak. Ellenőrizze az ablak számainak sorrendjét, a vetületüket és a telephely vetületét. Egy robotnak ez a térkép azt mondja, hogy minden szabad.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>There is no obstacle in the window: check its place and the site CRS.</source>
            <translation>Nincs akadály az ablakban: ellenőrizze a helyét és a telephely vetületét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Whether each feature is outdoors (default: true)</source>
            <translation>Szabadban van-e az egyes elem (alapértelmezés: igaz)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Window {width:g} m x {height:g} m = {area:.0f} m², from ({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f}) in the site frame</source>
            <translation>Ablak {width:g} m x {height:g} m = {area:.0f} m², ettől: ({x_min:.2f}, {y_min:.2f}), eddig: ({x_max:.2f}, {y_max:.2f}) a telephelyi keretben</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>Writes the obstacles of line and polygon layers inside a window as a map that robots read.</source>
            <translation>Vonal- és poligonrétegek akadályait írja ki egy ablakon belül robotok által olvasott térképként.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes in binary, {ratio:.3g} bytes/m²</source>
            <translation>{size} bájt binárisan, {ratio:.3g} bájt/m²</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map.py" />
            <source>{size} bytes of text, {ratio:.3g} bytes/m² (paper 1: about 3 bytes/m² as text)</source>
            <translation>{size} bájt szöveg, {ratio:.3g} bájt/m² (1. cikk: szövegként mintegy 3 bájt/m²)</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>%n tiles</source>
            <translation>
                <numerusform>%n csempe</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>&lt;p&gt;Writes one robot map for each tile, as &lt;i&gt;Export robot map&lt;/i&gt; does for one window, and an index: a polygon for each tile with its file, border, counts and bytes. The layers are read once.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Grid&lt;/b&gt;: tiles of one size from the left-lower corner of the extent; the last ones reach beyond it. &lt;b&gt;Route&lt;/b&gt;: tiles centred on the lines of a layer, so close that two that follow each other share the overlap. Sizes are in metres along the site's axes.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Advanced&lt;/b&gt;: obstacles are reduced as in &lt;i&gt;Export robot map&lt;/i&gt;, before the tiles are cut. The log says how many obstacles and segments the whole area had before and after.&lt;/p&gt; &lt;p&gt;An obstacle has the same id in every tile that it reaches into. Either every tile and the index are there at the end, or, after a cancel or an error, none of them.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Csempénként egy robottérképet ír ki, ahogy a &lt;i&gt;Robottérkép exportálása&lt;/i&gt; egy ablakhoz teszi, és egy indexet: csempénként egy poligont a fájljával, keretével, darabszámaival és bájtjaival. A rétegeket egyszer olvassa.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Rács&lt;/b&gt;: egyforma csempék a terjedelem bal alsó sarkától; az utolsók túlnyúlnak rajta. &lt;b&gt;Útvonal&lt;/b&gt;: egy réteg vonalaira középre tett csempék, olyan sűrűn, hogy két egymást követőnek közös legyen az átfedés. A méretek méterben értendők a telephely tengelyei mentén.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Haladó&lt;/b&gt;: az akadályok egyszerűsödnek, ahogy a &lt;i&gt;Robottérkép exportálása&lt;/i&gt; teszi, mielőtt a csempéket kivágja. A napló megmondja, hány akadály és szakasz volt az egész területen előtte és utána.&lt;/p&gt; &lt;p&gt;Egy akadály azonosítója ugyanaz minden csempében, amelybe belenyúlik. A végén vagy minden csempe és az index megvan, vagy megszakítás vagy hiba után egyik sem.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Both EXTENT and ROUTE are given: give one of them, for a grid or for tiles along a route.</source>
            <translation>EXTENT és ROUTE is meg van adva: adja meg az egyiket, rácshoz vagy útvonal menti csempékhez.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Export robot map tiles</source>
            <translation>Robottérkép-csempék exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Extent of a grid (or choose a route)</source>
            <translation>A rács kiterjedése (vagy válasszon útvonalat)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Folder of the tiles</source>
            <translation>A csempék mappája</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Height of a tile, along y [m]</source>
            <translation>Egy csempe magassága y mentén [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Index of the tiles</source>
            <translation>A csempék mutatója</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Leave out tiles without obstacles</source>
            <translation>Akadály nélküli csempék kihagyása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Neither EXTENT nor ROUTE is given: give an extent for a grid, or a layer of lines to follow.</source>
            <translation>Sem EXTENT, sem ROUTE nincs megadva: adjon meg kiterjedést a rácshoz, vagy követendő vonalak rétegét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OUTPUT {folder} is a file: choose a folder for the tiles.</source>
            <translation>OUTPUT {folder} egy fájl: válasszon mappát a csempéknek.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>OVERLAP is {overlap} m: give 0 or more, and at most nine tenths of a tile's side.</source>
            <translation>OVERLAP értéke {overlap} m: adjon meg 0-t vagy többet, legfeljebb a csempe oldalának kilenctizedét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Obstacles in all tiles</source>
            <translation>Akadályok az összes csempén</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE holds no line: choose a layer with the route to export along.</source>
            <translation>A ROUTE-ban nincs vonal: válasszon réteget azzal az útvonallal, amely mentén exportálni kell.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE {route} cannot be opened: choose a layer of lines.</source>
            <translation>ROUTE {route} nem nyitható meg: válasszon vonalréteget.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>ROUTE: feature {id} of {layer}: {doubts}. Correct the filter of the layer.</source>
            <translation>ROUTE: {layer} {id}. eleme: {doubts}. Javítsa ki a réteg szűrőjét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Route, instead of a grid</source>
            <translation>Útvonal, rács helyett</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Segments in all tiles</source>
            <translation>Szakaszok az összes csempén</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Size of all tiles [bytes]</source>
            <translation>Az összes csempe mérete [bájt]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less overlap or a smaller area.</source>
            <translation>Ez {count} csempe lenne, és legfeljebb {most_tiles} lehet: válasszon nagyobb csempéket, kisebb átfedést vagy kisebb területet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The index</source>
            <translation>Az index</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The set of tiles</source>
            <translation>A csempék készlete</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>The {name} of a tile is {value} m: give at least 1 m, such as 100.</source>
            <translation>Egy csempe mérete ({name}) {value} m: adjon meg legalább 1 m-t, például 100-at.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>There is no obstacle in any tile: check their place and the site CRS.</source>
            <translation>Egyik csempén sincs akadály: ellenőrizze a helyüket és a telephely vetületét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Tiles</source>
            <translation>Csempék</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>What neighbouring tiles share [m]</source>
            <translation>A szomszédos csempék közös része [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Width of a tile, along x [m]</source>
            <translation>Egy csempe szélessége x mentén [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>Writes many robot maps, in a grid or along a route, and a layer that tells which is where.</source>
            <translation>Sok robottérképet ír ki rácsban vagy útvonal mentén, és egy réteget, amely megmondja, melyik hol van.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/export_robot_map_tiles.py" />
            <source>{tiles}, {segments}, {size} bytes</source>
            <translation>{tiles}, {segments}, {size} bájt</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>&lt;p&gt;Reads a map of Nav2: the &lt;b&gt;YAML&lt;/b&gt; and the image that it names (PGM, PNG, BMP or JPEG), in the modes &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; and &lt;i&gt;raw&lt;/i&gt;, with its thresholds, &lt;i&gt;negate&lt;/i&gt;, and origin with yaw.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Raster&lt;/b&gt;: a value for each cell, 0 free to 100 occupied, -1 unknown. &lt;b&gt;Obstacles&lt;/b&gt;: a polygon for each patch of cells of at least &lt;i&gt;OCCUPIED_FROM&lt;/i&gt;, along the edges of the cells.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: the map's metres are those of the site frame. &lt;i&gt;SITE_CRS&lt;/i&gt;, &lt;i&gt;ORIGIN&lt;/i&gt; and &lt;i&gt;ROTATION&lt;/i&gt; say where that is; files of &lt;i&gt;Export navigation map&lt;/i&gt; say it themselves. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Nav2-térképet olvas be: a &lt;b&gt;YAML&lt;/b&gt;-fájlt és a benne megnevezett képet (PGM, PNG, BMP vagy JPEG), &lt;i&gt;trinary&lt;/i&gt;, &lt;i&gt;scale&lt;/i&gt; és &lt;i&gt;raw&lt;/i&gt; módban, a küszöbökkel, a &lt;i&gt;negate&lt;/i&gt; kapcsolóval és az elforgatott kezdőponttal.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Raszter&lt;/b&gt;: minden cellának egy értéke van, 0 szabad, 100 foglalt, -1 ismeretlen. &lt;b&gt;Akadályok&lt;/b&gt;: a legalább &lt;i&gt;OCCUPIED_FROM&lt;/i&gt; értékű cellák minden foltjának egy poligonja, a cellák szélei mentén.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Hely&lt;/b&gt;: a térkép méterei a telephelyi keret méterei. Hogy az hol van, a &lt;i&gt;SITE_CRS&lt;/i&gt;, az &lt;i&gt;ORIGIN&lt;/i&gt; és a &lt;i&gt;ROTATION&lt;/i&gt; mondja meg; a &lt;i&gt;Navigációs térkép exportálása&lt;/i&gt; fájljai maguk is megmondják. Ahol egyik sem, ott a rétegek helyi méterekben vannak, amit figyelmeztetés jelez.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:importnavigationmap -- MAP=warehouse.yaml SITE_CRS=EPSG:32633 ORIGIN="640420,5193480 [EPSG:32633]" ROTATION=0 RASTER=warehouse.tif OBSTACLES=warehouse.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Import navigation map</source>
            <translation>Navigációs térkép importálása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 map (YAML)</source>
            <translation>Nav2-térkép (YAML)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Nav2 maps (*.yaml *.yml);;All files (*)</source>
            <translation>Nav2-térképek (*.yaml *.yml);;Minden fájl (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied cells</source>
            <translation>Foglalt cellák</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Occupied from [of 100]</source>
            <translation>Foglalt ettől [100-ból]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Raster</source>
            <translation>Raszter</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Reads a Nav2 occupancy grid or mask as raster, and polygons of what is occupied.</source>
            <translation>Nav2 foglaltsági rácsot vagy maszkot olvas be raszterként és a foglalt helyek poligonjaiként.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The Nav2 map {file} cannot be read: {error}</source>
            <translation>A(z) {file} Nav2-térkép nem olvasható: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} cannot be read as PGM, PNG, BMP or JPEG: {why}</source>
            <translation>A(z) {file} kép nem olvasható PGM, PNG, BMP vagy JPEG képként: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The image {file} has no bands of 8 bits: save it as grey, without a palette.</source>
            <translation>A(z) {file} képnek nem 8 bites sávjai vannak: mentse szürkeként, paletta nélkül.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster</source>
            <translation>A raszter</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: QGIS reads rasters of this kind, and writes none. Give it a name that ends in .tif.</source>
            <translation>A(z) {file} raszter nem írható: a QGIS ilyen rasztert csak olvas. Adjon .tif végű nevet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>The raster {file} cannot be written: {why}</source>
            <translation>A(z) {file} raszter nem írható: {why}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no file {file}: choose the YAML of a Nav2 map (MAP).</source>
            <translation>Nincs {file} fájl: válassza ki egy Nav2-térkép YAML-fájlját (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>There is no image {file}, which the map names: put it there, or correct the YAML.</source>
            <translation>Nincs {file} kép, amelyet a térkép megnevez: tegye oda, vagy javítsa a YAML-fájlt.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/import_navigation_map.py" />
            <source>Unknown cells</source>
            <translation>Ismeretlen cellák</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n centrelines</source>
            <translation>
                <numerusform>%n úttengely</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n obstacle outlines</source>
            <translation>
                <numerusform>%n akadálykörvonal</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>%n road surfaces</source>
            <translation>
                <numerusform>%n útfelület</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>&lt;p&gt;Writes the layers of a site into a folder with &lt;i&gt;site.toml&lt;/i&gt; and &lt;i&gt;site.gpkg&lt;/i&gt;, which &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt; serves.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Layers&lt;/b&gt;: those of the project by their roles (menu Fleet Supervisor, Layer roles), or by a &lt;b&gt;map profile&lt;/b&gt;, or the layers given here. Which features count, heights, where things begin above the ground, labels, road widths and shapes of furniture come from the expressions kept with the roles; heights, labels and widths else from the fields &lt;i&gt;height&lt;/i&gt; or &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; or &lt;i&gt;width&lt;/i&gt;.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Version&lt;/b&gt;: 1 for a new folder, else one more than the version there. A folder that holds another site is refused unless &lt;b&gt;Replace&lt;/b&gt; is ticked.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Database&lt;/b&gt;: the site goes into PostgreSQL with PostGIS, too, or only there where no folder is given: the layers as tables, with views of the newest version in the schema &lt;i&gt;site_ID&lt;/i&gt;, and all that &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt; serves. It is a connection of QGIS's or such an address.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Bounds&lt;/b&gt;: the rectangle, along the axes of the site frame, that robots may be sent into. Obstacles are published up to 100 m beyond it, so that a robot at its edge is told what stands there.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Site CRS, origin, rotation&lt;/b&gt;: where the robots' (0, 0) is and how their x axis lies. Default: as the project has it.&lt;/p&gt; &lt;p&gt;An earlier publication is replaced only after the new one is complete; a cancel leaves it as it was. Broken geometry is repaired where that is safe and left out where it is not, each time with a warning that names the layer and the feature. One publication into a folder runs at a time.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Egy telephely rétegeit írja ki egy mappába &lt;i&gt;site.toml&lt;/i&gt; és &lt;i&gt;site.gpkg&lt;/i&gt; fájllal, amelyet a &lt;i&gt;robot-bridge serve --site FOLDER&lt;/i&gt; szolgál ki.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Rétegek&lt;/b&gt;: a projektéi szerepük szerint (Fleet Supervisor menü, Rétegszerepek), vagy egy &lt;b&gt;térképprofil&lt;/b&gt; szerint, vagy az itt megadott rétegek. Hogy mely elemek számítanak, a magasságok, hogy mi hol kezdődik a talaj felett, a címkék, az utak szélessége és a berendezések alakja a szerepekkel őrzött kifejezésekből jön; a magasság, a címke és a szélesség különben a &lt;i&gt;height&lt;/i&gt; vagy &lt;i&gt;height_m&lt;/i&gt;, &lt;i&gt;surface&lt;/i&gt;, &lt;i&gt;name&lt;/i&gt;, &lt;i&gt;width_m&lt;/i&gt; vagy &lt;i&gt;width&lt;/i&gt; mezőből.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Verzió&lt;/b&gt;: új mappánál 1, különben eggyel több, mint ami ott van. Más telephelyet tartalmazó mappát visszautasít, hacsak a &lt;b&gt;Másik telephely közzétételének felülírása&lt;/b&gt; nincs bejelölve.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Adatbázis&lt;/b&gt;: a telephely PostgreSQL-be is kerül PostGIS-szel, vagy csak oda, ha nincs mappa megadva: a rétegek táblákként, a legújabb verzió nézeteivel a &lt;i&gt;site_ID&lt;/i&gt; sémában, és minden, amit a &lt;i&gt;robot-bridge serve --site postgresql://account@host/database#ID&lt;/i&gt; szolgál ki. A QGIS egy kapcsolata vagy egy ilyen cím.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Határok&lt;/b&gt;: az a téglalap a telephelyi keret tengelyei mentén, ahová robotok küldhetők. Akadályok 100 m-rel azon túl is közzé vannak téve, hogy a szélén lévő robot tudja, mi áll ott.&lt;/p&gt; &lt;p&gt;&lt;b&gt;A telephely vetülete, kezdőpontja, elforgatása&lt;/b&gt;: hol van a robotok (0, 0) pontja, és merre fekszik az x tengelyük. Alapértelmezés: ahogy a projektben van.&lt;/p&gt; &lt;p&gt;Egy korábbi közzététel csak akkor cserélődik le, ha az új teljes; megszakításkor marad, ahogy volt. A hibás geometria ki lesz javítva, ahol ez biztonságos, és kimarad, ahol nem az, mindig figyelmeztetéssel, amely megnevezi a réteget és az elemet. Egy mappába egyszerre egy közzététel fut.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Id of the site</source>
            <translation>A telephely azonosítója</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Obstacle outlines</source>
            <translation>Akadálykörvonalak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Publish site</source>
            <translation>Telephely közzététele</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Schema of the site's views in the database</source>
            <translation>A telephely nézeteinek sémája az adatbázisban</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Site {id} version {version} is published in {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; bounds {bounds} m</source>
            <translation>A(z) {id} telephely {version}. verziója közzétéve itt: {folder}: {outlines}, {centrelines}, {surfaces}, {keepouts}; határok: {bounds} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The origin of the site frame is 0,0 of {crs}, {away:.0f} km from the site: robots get positions of seven digits. Give ORIGIN, a place of the site, unless that is meant.</source>
            <translation>A telephelyi keret origója a(z) {crs} 0,0 pontja, {away:.0f} km-re a telephelytől: a robotok hétjegyű helyzeteket kapnak. Adjon meg ORIGIN értéket, a telephely egy pontját, ha ez nem szándékos.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>The tables in the schema {schema} of an earlier version are in use: they stay until the next publication.</source>
            <translation>Egy korábbi verzió táblái a(z) {schema} sémában használatban vannak: a következő közzétételig maradnak.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>There is nothing to publish: the layers hold nothing that can be read. See the warnings, or give BOUNDS to publish an empty site.</source>
            <translation>Nincs mit közzétenni: a rétegekben nincs semmi olvasható. Nézze meg a figyelmeztetéseket, vagy adjon BOUNDS értéket üres telephely közzétételéhez.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Version of the site</source>
            <translation>A telephely verziója</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>Writes the layers of a site, by their roles, into the folder that a gateway serves.</source>
            <translation>A telephely rétegeit szerepeik szerint abba a mappába írja, amelyet egy átjáró szolgáltat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/publish_site.py" />
            <source>the database, schema {schema}</source>
            <translation>adatbázis, {schema} séma</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Checks a robot map, text or binary, and makes a layer of lines that show what is odd, each with a kind, a severity, the obstacle to look at, and what to do.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: outlines, courtyards, segments or risers that run the wrong way round. &lt;b&gt;gap&lt;/b&gt;: rings that do not close, and lines that stop just short of another obstacle. &lt;b&gt;sliver&lt;/b&gt;: rings next to nothing wide, segments without length. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: obstacles that repeat, cross or cover one another or lie inside another. &lt;b&gt;shared wall&lt;/b&gt;: where two outlines touch back to back. &lt;b&gt;pocket&lt;/b&gt;: free space that a robot of the given width cannot reach; courtyards are such pockets. &lt;b&gt;height&lt;/b&gt;: heights of 0 or less, or above 0 where there must be none. &lt;b&gt;outside&lt;/b&gt;: segments beyond the border. &lt;b&gt;id&lt;/b&gt;: ids used twice.&lt;/p&gt; &lt;p&gt;Severities: &lt;i&gt;error&lt;/i&gt; misleads a robot, &lt;i&gt;warning&lt;/i&gt; is probably not meant, &lt;i&gt;info&lt;/i&gt; is worth knowing. The map itself is not changed.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Ellenőriz egy szöveges vagy bináris robottérképet, és vonalréteget készít arról, ami furcsa, mindegyiknél a fajtával, a súlyossággal, a megnézendő akadállyal és a teendővel.&lt;/p&gt; &lt;p&gt;&lt;b&gt;orientation&lt;/b&gt;: rossz irányba futó körvonalak, udvarok, szakaszok vagy lépcsőfokok. &lt;b&gt;gap&lt;/b&gt;: nem záródó gyűrűk, és vonalak, amelyek épp egy másik akadály előtt végződnek. &lt;b&gt;sliver&lt;/b&gt;: szinte szélesség nélküli gyűrűk, hossz nélküli szakaszok. &lt;b&gt;duplicate&lt;/b&gt;, &lt;b&gt;overlap&lt;/b&gt;: akadályok, amelyek ismétlődnek, keresztezik vagy fedik egymást, vagy egy másikban vannak. &lt;b&gt;shared wall&lt;/b&gt;: ahol két körvonal háttal összeér. &lt;b&gt;pocket&lt;/b&gt;: szabad terület, amelyet egy adott szélességű robot nem ér el; az udvarok ilyenek. &lt;b&gt;height&lt;/b&gt;: 0 vagy kisebb magasságok, vagy 0 felettiek, ahol nem lehet ilyen. &lt;b&gt;outside&lt;/b&gt;: a kereten túli szakaszok. &lt;b&gt;id&lt;/b&gt;: kétszer használt azonosítók.&lt;/p&gt; &lt;p&gt;Súlyosság: az &lt;i&gt;error&lt;/i&gt; félrevezet egy robotot, a &lt;i&gt;warning&lt;/i&gt; valószínűleg nem szándékos, az &lt;i&gt;info&lt;/i&gt; érdemes tudni. Maga a térkép nem változik.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>&lt;p&gt;Reads a robot map, text or binary, and makes layers of it.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Obstacles that are areas&lt;/b&gt;: outlines that close, courtyards as holes. &lt;b&gt;Obstacles that are lines&lt;/b&gt;: walls, stairs, and what the border of the map cuts. &lt;b&gt;Segments&lt;/b&gt;: each from a to b, with free space on its right; the style shows that side by ticks and the height by colour. Fields: id, shape, labels, height, indoors or outdoors, extras (&lt;i&gt;ext&lt;/i&gt;, as JSON).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Place&lt;/b&gt;: a map may name its CRS, origin and rotation in its leading lines; parameters win over them. Where neither does, the layers are in local metres, said in a warning.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Szöveges vagy bináris robottérképet olvas, és rétegeket készít belőle.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Területszerű akadályok&lt;/b&gt;: záródó körvonalak, az udvarok lyukak. &lt;b&gt;Vonalszerű akadályok&lt;/b&gt;: falak, lépcsők, és amit a térkép kerete elvág. &lt;b&gt;Szakaszok&lt;/b&gt;: mindegyik a-tól b-ig, jobbján szabad területtel; a stílus ezt az oldalt rovátkákkal, a magasságot színnel mutatja. Mezők: azonosító, alak, címkék, magasság, bent vagy kint, továbbiak (&lt;i&gt;ext&lt;/i&gt;, JSON-ként).&lt;/p&gt; &lt;p&gt;&lt;b&gt;Hely&lt;/b&gt;: a térkép bevezető sorai megnevezhetik vetületét, kezdőpontját és elforgatását; a paraméterek előbbre valók. Ahol egyik sem mondja meg, a rétegek helyi méterekben vannak, figyelmeztetéssel.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Border of the map</source>
            <translation>A térkép határa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Check robot map</source>
            <translation>Robottérkép ellenőrzése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Errors</source>
            <translation>Hibák</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Findings</source>
            <translation>Találatok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Finds turned outlines, gaps, slivers, repeats, overlaps and unreachable pockets in a robot map.</source>
            <translation>Megfordított körvonalakat, hézagokat, szilánkokat, ismétléseket, átfedéseket és elérhetetlen zugokat keres egy robottérképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Load robot map</source>
            <translation>Robottérkép betöltése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Longest gap that was not meant [m]</source>
            <translation>A leghosszabb nem szándékos hézag [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Narrowest ring that is an obstacle [m]</source>
            <translation>A legkeskenyebb gyűrű, amely akadály [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Nothing is odd in this map.</source>
            <translation>Ezen a térképen semmi sem furcsa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are areas</source>
            <translation>Akadályok, amelyek területek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Obstacles that are lines</source>
            <translation>Akadályok, amelyek vonalak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Smallest unreachable pocket [m²]</source>
            <translation>A legkisebb elérhetetlen zug [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Turns a robot map, text or binary, into layers with all that the map says.</source>
            <translation>Szöveges vagy bináris robottérképet alakít rétegekké mindazzal, amit a térkép mond.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Width of the robot, for unreachable pockets [m]</source>
            <translation>A robot szélessége, az elérhetetlen zugokhoz [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/read_robot_maps.py" />
            <source>Worth knowing</source>
            <translation>Jó tudni</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n nodes</source>
            <translation>
                <numerusform>%n csomópont</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n parts</source>
            <translation>
                <numerusform>%n rész</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n points</source>
            <translation>
                <numerusform>%n pont</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>%n repairs</source>
            <translation>
                <numerusform>%n javítás</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Checks the network that road centrelines make, and makes a layer of points that show what is odd, each with the feature to look at. Nothing is changed.&lt;/p&gt; &lt;p&gt;What &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; repairs: &lt;b&gt;gap&lt;/b&gt;, an end that stops within the tolerance of another road; &lt;b&gt;overshoot&lt;/b&gt;, an end that reaches beyond a road by less than that; &lt;b&gt;duplicate&lt;/b&gt;, a stretch that is drawn twice.&lt;/p&gt; &lt;p&gt;What only people can judge: &lt;b&gt;dead end&lt;/b&gt;; &lt;b&gt;disconnected part&lt;/b&gt;, roads that are connected with one another but not with the longest part; &lt;b&gt;one-way&lt;/b&gt;, roads from which no way leads back because of the directions.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Ellenőrzi az úttengelyekből álló hálózatot, és pontréteget készít arról, ami furcsa, mindegyiknél a megnézendő elemmel. Semmit sem változtat.&lt;/p&gt; &lt;p&gt;Amit a &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; kijavít: &lt;b&gt;rés&lt;/b&gt; (gap), egy vég, amely a tűrésen belül egy másik út előtt megáll; &lt;b&gt;túlnyúlás&lt;/b&gt; (overshoot), egy vég, amely ennél kevesebbel nyúlik túl egy úton; &lt;b&gt;kettőzés&lt;/b&gt; (duplicate), kétszer megrajzolt szakasz.&lt;/p&gt; &lt;p&gt;Amit csak ember ítélhet meg: &lt;b&gt;zsákutca&lt;/b&gt; (dead end); &lt;b&gt;különálló rész&lt;/b&gt; (disconnected part), egymással összefüggő utak, amelyek a leghosszabb résszel nem; &lt;b&gt;egyirányú&lt;/b&gt; (one-way), utak, ahonnan az irányok miatt nincs út vissza.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Finds the way between two places near roads: each is taken to the nearest point of a road that may be used. Closed roads are not used, one-way roads in their direction only; &lt;b&gt;surfaces&lt;/b&gt; (names with commas between) and a &lt;b&gt;least width&lt;/b&gt; restrict the way further.&lt;/p&gt; &lt;p&gt;Edges that lead through a polygon of the &lt;b&gt;areas that must not be driven through&lt;/b&gt; are closed; what runs along a rim is not.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Route&lt;/b&gt; has a line for each stretch of road, in order. &lt;b&gt;Path&lt;/b&gt; is what a robot drives: points at most so far apart, corners rounded to the turning radius as far as robot and road are wide. Corners that stay tighter are counted and named in the log.&lt;/p&gt; &lt;p&gt;The &lt;b&gt;engine&lt;/b&gt; is RoutingKit or SciPy where Python has them, else QGIS's own; the log and &lt;i&gt;ENGINE_USED&lt;/i&gt; say which was used. All find the same ways.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Megkeresi az utat két, utakhoz közeli hely között: mindegyik annak az útnak a legközelebbi pontjára kerül, amely használható. Lezárt utakat nem használ, egyirányúakat csak az irányukban; a &lt;b&gt;felületek&lt;/b&gt; (nevek vesszővel elválasztva) és a &lt;b&gt;legkisebb szélesség&lt;/b&gt; tovább szűkítik az utat.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;területek, amelyeken nem szabad áthajtani&lt;/b&gt; poligonjain átvezető élek le vannak zárva; ami a peremükön fut, nincs.&lt;/p&gt; &lt;p&gt;Az &lt;b&gt;útvonalban&lt;/b&gt; minden útszakasznak van egy vonala, sorrendben. A &lt;b&gt;pálya&lt;/b&gt; az, amit a robot bejár: legfeljebb ilyen távoli pontok, a sarkok a fordulási sugárra lekerekítve, amennyire a robot és az út széles. A szűkebben maradó sarkokat megszámolja és a naplóban megnevezi.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;motor&lt;/b&gt; a RoutingKit vagy a SciPy, ahol a Pythonban megvan, különben a QGIS sajátja; a napló és az &lt;i&gt;ENGINE_USED&lt;/i&gt; megmondja, melyik volt. Mind ugyanazokat az utakat találja.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]" GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>&lt;p&gt;Splits road centrelines where they cross or touch, and makes a layer of edges and one of nodes.&lt;/p&gt; &lt;p&gt;Roads of different &lt;b&gt;levels&lt;/b&gt; meet only where one of them ends in a point of the other: a bridge is reached at its ends and passes over what is between them. &lt;b&gt;Direction&lt;/b&gt;, speed, width, surface and whether a road is closed go over to its edges.&lt;/p&gt; &lt;p&gt;&lt;b&gt;Repair&lt;/b&gt; moves ends that stop within the tolerance of a road onto it, cuts off ends that reach beyond a road by less, and leaves out what is drawn twice; the log names each repair. &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; shows what is broken without changing anything.&lt;/p&gt; &lt;p&gt;The fields of the edges are those that this algorithm and &lt;i&gt;fleet:route&lt;/i&gt; read by themselves. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Szétvágja az úttengelyeket, ahol keresztezik vagy érintik egymást, és egy réteget készít az élekből, egyet a csomópontokból.&lt;/p&gt; &lt;p&gt;Különböző &lt;b&gt;szintű&lt;/b&gt; utak csak ott találkoznak, ahol egyikük a másik egy pontjában végződik: egy hídra a végein lehet rámenni, és átível azon, ami közöttük van. Az &lt;b&gt;irány&lt;/b&gt;, a sebesség, a szélesség, a felület és hogy le van-e zárva egy út, átmegy az éleire.&lt;/p&gt; &lt;p&gt;A &lt;b&gt;javítás&lt;/b&gt; az út mellett a tűrésen belül végződő végeket rátolja, a túlnyúló végeket levágja, ha kevesebbel nyúlnak túl, és elhagyja, ami kétszer van megrajzolva; a napló minden javítást megnevez. A &lt;i&gt;fleet:checkroadnetwork&lt;/i&gt; megmutatja, mi hibás, és semmit sem változtat.&lt;/p&gt; &lt;p&gt;Az élek mezőit ez az algoritmus és a &lt;i&gt;fleet:route&lt;/i&gt; magától olvassa. Bővebben: docs/roads.md.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Build road network</source>
            <translation>Úthálózat készítése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Check road network</source>
            <translation>Úthálózat ellenőrzése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Corners tighter than the robot turns</source>
            <translation>A robot fordulásánál élesebb sarkok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Dead ends</source>
            <translation>Zsákutcák</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Edges without a way back</source>
            <translation>Élek visszaút nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine</source>
            <translation>Motor</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Engine that was used</source>
            <translation>Használt motor</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds gaps, overshoots, duplicates, dead ends, separate parts and one-way traps in road centrelines.</source>
            <translation>Hézagokat, túlnyúlásokat, kettőzéseket, zsákutcákat, különálló részeket és egyirányú csapdákat keres az úttengelyekben.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Finds the shortest or fastest way along road centrelines, and the path that a robot drives.</source>
            <translation>Megkeresi a legrövidebb vagy leggyorsabb utat az úttengelyek mentén, és a pályát, amelyen a robot halad.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Gaps</source>
            <translation>Hézagok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Goal</source>
            <translation>Végpont</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Length of the route [m]</source>
            <translation>Az útvonal hossza [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Nodes</source>
            <translation>Csomópontok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Nothing is odd in this network.</source>
            <translation>Ebben a hálózatban semmi sem furcsa.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Overshoots</source>
            <translation>Túlnyúlások</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts of their own</source>
            <translation>Különálló részek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Parts that are not connected</source>
            <translation>Össze nem függő részek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Path</source>
            <translation>Pálya</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Points of the path</source>
            <translation>A pálya pontjai</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Repairs</source>
            <translation>Javítások</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Roads drawn twice</source>
            <translation>Kétszer rajzolt utak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route</source>
            <translation>Útvonal</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Route on roads</source>
            <translation>Útvonal utakon</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Splits road centrelines where they meet, passes over and under at bridges, and repairs on request.</source>
            <translation>Az úttengelyeket találkozásaiknál felosztja, hidaknál alattuk és felettük átvezeti, és kérésre kijavítja.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Start</source>
            <translation>Kiindulás</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>The corner at ({x:.2f}, {y:.2f}) is tighter than the robot turns.</source>
            <translation>A ({x:.2f}, {y:.2f}) ponton lévő sarok élesebb, mint ahogy a robot fordul.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>Time on the route [s]</source>
            <translation>Idő az útvonalon [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>fastest</source>
            <translation>leggyorsabb</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>none: plain Python</source>
            <translation>egyik sem: csak Python</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>shortest</source>
            <translation>legrövidebb</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>the fastest that is installed</source>
            <translation>a telepítettek közül a leggyorsabb</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_network.py" />
            <source>{metres:.1f} m, {seconds:.1f} s, {points}, found by {engine}; start {off_start:.2f} m and goal {off_goal:.2f} m from the road</source>
            <translation>{metres:.1f} m, {seconds:.1f} s, {points}, megtalálta: {engine}; a kiindulás {off_start:.2f} m-re, a végpont {off_goal:.2f} m-re van az úttól</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n of the surfaces that are given as drawn say that they were generated (field origin); they are left out and made anew</source>
            <translation>
                <numerusform>%n rajzoltként megadott felület azt mondja magáról, hogy előállított (origin mező); kimarad, és újra elkészül</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>%n points are on a surface, {off} on none.</source>
            <translation>
                <numerusform>%n pont van felületen, {off} egyiken sem.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Copies points and adds &lt;b&gt;surface&lt;/b&gt;, the class of the road surface that each is on, its &lt;b&gt;surface_name&lt;/b&gt;, and &lt;b&gt;surface_origin&lt;/b&gt;: whether the surface was drawn or generated from centrelines. They are empty where there is no surface.&lt;/p&gt; &lt;p&gt;The surfaces are layers of areas with a field &lt;i&gt;surface&lt;/i&gt;, or the class that their role says; without any, the project's layers with the role road surface. Points and layers may be in any CRS.&lt;/p&gt; &lt;p&gt;A point on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a generated one, then the smaller before the larger. The expression &lt;i&gt;road_surface(x, y)&lt;/i&gt; tells the same. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Lemásolja a pontokat, és hozzáteszi a &lt;b&gt;surface&lt;/b&gt; mezőt, annak az útfelületnek az osztályát, amelyen mindegyik van, a &lt;b&gt;surface_name&lt;/b&gt; mezőt, a nevét, és a &lt;b&gt;surface_origin&lt;/b&gt; mezőt: hogy a felületet rajzolták-e, vagy tengelyekből készült. Ahol nincs felület, üresek.&lt;/p&gt; &lt;p&gt;A felületek területrétegek &lt;i&gt;surface&lt;/i&gt; mezővel vagy a szerepük szerinti osztállyal; ha egy sincs megadva, a projekt útfelület szerepű rétegei. A pontok és rétegek bármilyen vetületben lehetnek.&lt;/p&gt; &lt;p&gt;A peremen lévő pont a felületen van. Ahol felületek fedik egymást, a rajzolt előbbre való a generáltnál, azután a kisebb a nagyobbnál. A &lt;i&gt;road_surface(x, y)&lt;/i&gt; kifejezés ugyanezt mondja. Bővebben: docs/roads.md.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>&lt;p&gt;Widens road centrelines by half their width to each side: ends are cut square, corners are mitred, within a road and where roads end in one point. What is of one class, such as asphalt, becomes one surface; pieces that do not touch are features of their own.&lt;/p&gt; &lt;p&gt;No ground is in two surfaces. Surfaces &lt;b&gt;drawn by hand&lt;/b&gt; keep theirs and are copied to the result. Among generated ones the class that comes first in &lt;b&gt;precedence&lt;/b&gt; keeps the ground; of classes that are not named there the one with less ground, and what has no class comes last.&lt;/p&gt; &lt;p&gt;A road whose width is not known is as wide as &lt;b&gt;default width&lt;/b&gt; says, and is in the layer of &lt;b&gt;findings&lt;/b&gt;. Ends that stop just short of another road stay apart: mend them with &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; and give its edges.&lt;/p&gt; &lt;p&gt;Give the result the role road surface to publish it. docs/roads.md says more.&lt;/p&gt;</source>
            <translation>&lt;p&gt;Az úttengelyeket szélességük felével kiszélesíti mindkét oldalra: a végeket merőlegesen vágja le, a sarkokat hegyesen zárja, egy úton belül és ahol utak egy pontban végződnek. Ami egy osztályú, például aszfalt, egy felület lesz; az egymáshoz nem érő darabok külön elemek.&lt;/p&gt; &lt;p&gt;Egyetlen terület sincs két felületben. A &lt;b&gt;kézzel rajzolt&lt;/b&gt; felületek megtartják a magukét, és átmásolódnak az eredménybe. A generáltak közül az az osztály tartja meg a területet, amelyik a &lt;b&gt;sorrendben&lt;/b&gt; előbb áll; a meg nem nevezettek közül a kisebb területű, és ami osztály nélküli, az az utolsó.&lt;/p&gt; &lt;p&gt;Az ismeretlen szélességű út olyan széles, amennyit az &lt;b&gt;alapértelmezett szélesség&lt;/b&gt; mond, és szerepel a &lt;b&gt;leletek&lt;/b&gt; rétegében. A másik út előtt épp hogy véget érő végek elválva maradnak: javítsa őket a &lt;i&gt;fleet:buildroadnetwork&lt;/i&gt; algoritmussal, és annak éleit adja meg.&lt;/p&gt; &lt;p&gt;Közzétételhez adja az eredménynek az útfelület szerepet. Bővebben: docs/roads.md.&lt;/p&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Adds to points, in any CRS, the class of the road surface that they are on.</source>
            <translation>Bármely vetületű pontokhoz hozzáadja annak az útfelületnek az osztályát, amelyen vannak.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Area [m²]</source>
            <translation>Terület [m²]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Build road surfaces</source>
            <translation>Útfelületek készítése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Classes that keep their ground, the first before the second</source>
            <translation>A területüket megtartó osztályok, az első a második előtt</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Feature {id} has points on several surfaces; none is given for it</source>
            <translation>A(z) {id}. elem pontjai több felületen vannak; egyik sincs megadva hozzá</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Generated ones</source>
            <translation>Ebből előállított</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>No road surfaces are given, and no layer of the project has the role road surface: give SURFACES, or set the role in Plugins &gt; Fleet Supervisor &gt; Layer roles.</source>
            <translation>Nincsenek megadva útfelületek, és a projekt egyik rétegének sem útfelület a szerepe: adja meg a SURFACES-t, vagy állítsa be a szerepet a Modulok &gt; Fleet Supervisor &gt; Rétegszerepek ablakban.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>POINTS {name} is a table without places: make points of its columns first, by native:createpointslayerfromtable.</source>
            <translation>A POINTS {name} helyek nélküli táblázat: előbb készítsen pontokat az oszlopaiból a native:createpointslayerfromtable algoritmussal.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points</source>
            <translation>Pontok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on a surface</source>
            <translation>Pontok felületen</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points on none</source>
            <translation>Pontok felületen kívül</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Points with surface</source>
            <translation>Pontok felülettel</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Road surfaces (default: the project's layers with that role)</source>
            <translation>Útfelületek (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Roads without a width</source>
            <translation>Szélesség nélküli utak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surface at point</source>
            <translation>Felület a pontban</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Surfaces drawn by hand, which keep their ground</source>
            <translation>Kézzel rajzolt felületek, amelyek megtartják helyüket</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>The width of this road is not known; {width:g} m is used.</source>
            <translation>Ennek az útnak a szélessége nem ismert; {width:g} m lesz használva.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>Widens centrelines to surfaces, one for each class; surfaces drawn by hand keep their ground.</source>
            <translation>Az úttengelyeket felületekké szélesíti, osztályonként eggyé; a kézzel rajzolt felületek megtartják helyüket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>without a class</source>
            <translation>osztály nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/road_surfaces.py" />
            <source>{label}: {area:.1f} m²</source>
            <translation>{label}: {area:.1f} m²</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n features have no place, robot or time; they are left out.</source>
            <translation>
                <numerusform>%n elemnek nincs helye, robotja vagy ideje; kimarad.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n lines</source>
            <translation>
                <numerusform>%n vonal</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n positions</source>
            <translation>
                <numerusform>%n helyzet</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>%n values of the field {name} are no numbers, and count as no speed.</source>
            <translation>
                <numerusform>A(z) {name} mező %n értéke nem szám, és nem számít sebességnek.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>&lt;p&gt;Makes of the positions that a gateway stored one line for each drive of each robot: a robot that was not heard of for longer than the gap begins a new line. Or, with &lt;b&gt;a line for each step&lt;/b&gt;, one for each pair of positions, for colours by speed and for QGIS's temporal controller.&lt;/p&gt; &lt;p&gt;The positions are the layer &lt;i&gt;positions&lt;/i&gt; of &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt;, or any points, in any CRS, with a field for the robot and one for the time (date and time, seconds since 1970, or ISO 8601; without an offset UTC).&lt;/p&gt; &lt;p&gt;Fields: &lt;b&gt;begin&lt;/b&gt; and &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; and &lt;b&gt;top_speed&lt;/b&gt; in m/s (as the robot told it, else its fastest step), &lt;b&gt;count&lt;/b&gt; of positions. The measure M of each vertex is its time in seconds since 1970. Lengths are measured in the layer's CRS if that is in true metres, as robots drive them, else on its ellipsoid.&lt;/p&gt; &lt;p&gt;The layer's times are set: open QGIS's temporal controller to play them.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</source>
            <translation>&lt;p&gt;Az átjáró által tárolt helyzetekből minden robot minden menetéhez egy vonalat készít: ha a robot a szünetnél hosszabban hallgatott, új vonal kezdődik. Vagy a &lt;b&gt;lépésenként egy vonal&lt;/b&gt; beállítással minden helyzetpárhoz egyet, sebesség szerinti színezéshez és a QGIS időbeli vezérlőjéhez.&lt;/p&gt; &lt;p&gt;A helyzetek a &lt;i&gt;robot-bridge trajectories export drives.gpkg --site site&lt;/i&gt; &lt;i&gt;positions&lt;/i&gt; rétege, vagy bármilyen pontok, bármilyen vetületben, egy mezővel a robotnak és eggyel az időnek (dátum és idő, másodpercek 1970 óta, vagy ISO 8601; eltolás nélkül UTC).&lt;/p&gt; &lt;p&gt;Mezők: &lt;b&gt;begin&lt;/b&gt; és &lt;b&gt;end&lt;/b&gt; (UTC), &lt;b&gt;duration_s&lt;/b&gt;, &lt;b&gt;length_m&lt;/b&gt;, &lt;b&gt;mean_speed&lt;/b&gt; és &lt;b&gt;top_speed&lt;/b&gt; m/s-ban (ahogy a robot mondta, különben a leggyorsabb lépése), &lt;b&gt;count&lt;/b&gt;, a helyzetek száma. Minden töréspont M értéke az ideje másodpercben 1970 óta. A hosszak a réteg vetületében értendők, ha annak méterei valódiak, ahogy a robotok megteszik, különben az ellipszoidján.&lt;/p&gt; &lt;p&gt;A réteg idői be vannak állítva: a lejátszáshoz nyissa meg a QGIS időbeli vezérlőjét.&lt;/p&gt; &lt;pre&gt;qgis_process run fleet:trajectories -- INPUT="drives.gpkg|layername=positions" OUTPUT=lines.gpkg&lt;/pre&gt;</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>A line for each step</source>
            <translation>Lépésenként egy vonal</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the robot</source>
            <translation>A robot mezője</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the speed [m/s]</source>
            <translation>A sebesség mezője [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Field of the time</source>
            <translation>Az idő mezője</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Lines</source>
            <translation>Vonalak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Longest gap in a line [s]</source>
            <translation>Leghosszabb szünet egy vonalban [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Makes lines of stored positions, with their time, length and speed.</source>
            <translation>A tárolt helyzetekből vonalakat készít, idejükkel, hosszukkal és sebességükkel.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Metres driven, all robots</source>
            <translation>Megtett méterek, minden robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Positions</source>
            <translation>Helyzetek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>The positions have no field {name} for the {what}: they have {names}. Give the layer 'positions' of 'robot-bridge trajectories export', or say which field it is.</source>
            <translation>A helyzeteknek nincs {name} mezőjük ehhez: {what}; ezek vannak: {names}. Adja meg a 'robot-bridge trajectories export' 'positions' rétegét, vagy mondja meg, melyik mező az.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>Trajectories</source>
            <translation>Trajektóriák</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>robot</source>
            <translation>robot</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>time</source>
            <translation>idő</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/algorithms/trajectories.py" />
            <source>{lines} of {positions}, {length:.1f} m in all.</source>
            <translation>{lines}, {positions}, összesen {length:.1f} m.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'x,y', or 'x,y [EPSG:4326]' in another CRS</source>
            <translation>„x,y”, vagy más vetületben „x,y [EPSG:4326]”</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>'xmin,xmax,ymin,ymax'</source>
            <translation>„xmin,xmax,ymin,ymax”</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>It was cancelled before its end.</source>
            <translation>Befejezés előtt megszakították.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>Robot maps</source>
            <translation>Robottérképek</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>There is no parameter {name}: correct it or leave it out. There are: {names}.</source>
            <translation>Nincs {name} nevű paraméter: javítsa ki vagy hagyja el. Ezek vannak: {names}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>a number</source>
            <translation>egy szám</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>one of {options}</source>
            <translation>a következők egyike: {options}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>true or false</source>
            <translation>true vagy false</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name} is {value}: give {wanted}.</source>
            <translation>{name} értéke {value}: adja meg így: {wanted}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.</source>
            <translation>{name}: a(z) {file} fájlban {count} réteg van ({layers}): adja meg, melyik kell, így: {file}|layername={first}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/algorithm.py" />
            <source>{name}: the layer {layer} cannot be opened: check the file, and the layer's name after '|layername='.</source>
            <translation>{name}: a(z) {layer} réteg nem nyitható meg: ellenőrizze a fájlt és a réteg nevét a '|layername=' után.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Classes of surface that are allowed, such as asphalt (default: all)</source>
            <translation>Megengedett felületosztályok, például asphalt (alapértelmezés: mind)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance between cones [m]</source>
            <translation>Távolság a bóják között [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Distance to obstacles [m]</source>
            <translation>Távolság az akadályoktól [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Layer {name}: {note}</source>
            <translation>{name} réteg: {note}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No layer of surfaces is given: whether the cones stand on the road is not checked.</source>
            <translation>Nincs megadva felületréteg: nincs ellenőrizve, hogy a bóják az úton állnak-e.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>No surface is of class {classes}: the layers have {classes_there}.</source>
            <translation>Nincs {classes} osztályú felület: a rétegekben ez van: {classes_there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Nothing is wrong with the places of the cones.</source>
            <translation>A bóják helyével nincs baj.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Obstacles to keep away from</source>
            <translation>Elkerülendő akadályok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Site CRS, in metres (default: the project's, else the line's or the layer's)</source>
            <translation>A telephely vetülete méterben (alapértelmezés: a projekté, különben a vonalé vagy a rétegé)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>Surfaces to stand on (default: not checked)</source>
            <translation>Felületek, amelyeken állniuk kell (alapértelmezés: nincs ellenőrizve)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>The CRS of the site is not known: give SITE_CRS, such as EPSG:32633.</source>
            <translation>A telephely vetülete nem ismert: adja meg a SITE_CRS-t, például EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>There are no findings: their layer is empty, and is not loaded.</source>
            <translation>Nincs találat: a rétegük üres, ezért nem töltődik be.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}, feature {id}</source>
            <translation>{layer}, {id}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value!r}, which is no number; correct it.</source>
            <translation>{layer}: {field} értéke {value!r}, ami nem szám; javítsa ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{layer}: {field} is {value:g}; give a whole number.</source>
            <translation>{layer}: {field} értéke {value:g}; adjon meg egész számot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{name}, feature {id}</source>
            <translation>{name}, {id}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/cone_layers.py" />
            <source>{where} is not one point with a place on the site: correct or delete it.</source>
            <translation>{where} nem egyetlen pont, amelynek helye van a telephelyen: javítsa ki vagy törölje.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. An outline that would cross itself stays as it is. Needs the Python package shapely 2.</source>
            <translation>0: kikapcsolva. Amelyik körvonal önmagát metszené, az marad, ahogy van. A shapely 2 Python-csomag kell hozzá.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Ends of lines stay and rings keep three corners. Needs the Python package shapely 2.</source>
            <translation>0: kikapcsolva. A vonalak végei maradnak, és a gyűrűk három sarkot megtartanak. A shapely 2 Python-csomag kell hozzá.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>0 is off. Half a metre makes a compact map smaller still, and no obstacle lower than it is.</source>
            <translation>0: kikapcsolva. A fél méter tovább csökkenti a tömör térképet, és egyetlen akadályt sem tesz alacsonyabbá.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>A whole map lies inside of {sources} and has no wall of it: maps hold walls alone, and do not say that a robot is in there. Choose a larger window or larger tiles.</source>
            <translation>Egy teljes térkép ezen belül van, és egyetlen falát sem tartalmazza: {sources}. A térképeken csak falak vannak, és nem mondják meg, hogy a robot odabent van. Válasszon nagyobb ablakot vagy nagyobb csempéket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Bare map: no leading lines, no extras</source>
            <translation>Puszta térkép: bevezető sorok és kiegészítések nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.</source>
            <translation>DEFAULT_HEIGHT értéke {height}: adjon meg 0 vagy több métert.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>DISSOLVE, TOLERANCE and SHORTEST need the Python package shapely 2, and {version} is installed here: install a newer one (python3 -m pip install 'shapely&gt;=2'), or leave them off.</source>
            <translation>A DISSOLVE, TOLERANCE és SHORTEST értékhez a shapely 2 Python-csomag kell, és itt {version} van telepítve: telepítsen újabbat (python3 -m pip install 'shapely&gt;=2'), vagy hagyja őket kikapcsolva.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Fewer corners: how far an outline may then be from the drawn one [m]</source>
            <translation>Kevesebb sarok: milyen messze lehet így egy körvonal a rajzolttól [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Format (compact: binary in columns, about a third of binary)</source>
            <translation>Formátum (compact: bináris oszlopokban, a bináris mintegy harmada)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Heights are rounded up to a multiple of this [m]</source>
            <translation>A magasságok felkerekítése ennek többszörösére [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Join lines that meet end to end into one obstacle</source>
            <translation>Összeérő vonalak egy akadállyá egyesítése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Leave out walls that no robot outside can meet</source>
            <translation>Kívülről el nem érhető falak kihagyása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>No obstacle layer is given, and no layer of the project has a role of obstacles. Give OBSTACLES, roles (Fleet Supervisor &gt; Layer roles), or a PROFILE.</source>
            <translation>Nincs megadva akadályréteg, és a projekt egyetlen rétegének sincs akadályszerepe. Adjon meg OBSTACLES értéket, szerepeket (Fleet Supervisor &gt; Layer roles) vagy PROFILE értéket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>OUTPUT {target} is the file of the layer {layer}: choose another one.</source>
            <translation>OUTPUT {target} a(z) {layer} réteg fájlja: válasszon másikat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Obstacle layers (default: those of the project with such a role)</source>
            <translation>Akadályrétegek (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Only lines that are alike in height, label and all else. The source of a joined line is that of its first part and how many others are in it, such as walls:3+7.</source>
            <translation>Csak olyan vonalak, amelyek magassága, címkéje és minden más azonos. Az egyesített vonal forrása az első részé és hogy hány másik van benne, például walls:3+7.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>PLANE_LOW is {low:g} and PLANE_HIGH {high:g}: give the lower and the upper height in metres.</source>
            <translation>PLANE_LOW értéke {low:g}, PLANE_HIGH értéke {high:g}: adja meg az alsó és a felső magasságot méterben.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Reducing obstacles</source>
            <translation>Akadályok egyszerűsítése</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane from [m above the ground]</source>
            <translation>A robot síkja ettől [m a talaj felett]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Robot's plane up to [m above the ground]</source>
            <translation>A robot síkja eddig [m a talaj felett]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Shortest segment: corners nearer than this to the one before are left out [m]</source>
            <translation>Legrövidebb szakasz: az előzőhöz ennél közelebbi sarkok kimaradnak [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The layer {layer} is no vector layer: leave it out.</source>
            <translation>A(z) {layer} réteg nem vektorréteg: hagyja ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>The robot map</source>
            <translation>A robottérkép</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>Those between buildings that touch, and lines inside or along buildings. What stays keeps its height and its source. Needs the Python package shapely 2.</source>
            <translation>Az érintkező épületek közöttieket, valamint az épületekben vagy mentén futó vonalakat. Ami marad, megtartja magasságát és forrását. A shapely 2 Python-csomag kell hozzá.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What begins at this height or above it is left out: the robot drives under it. Where things begin is said by the layers or by the parameter BASE_EXPRESSION.</source>
            <translation>Ami ezen a magasságon vagy felette kezdődik, kimarad: a robot áthajt alatta. Hogy mi hol kezdődik, a rétegek vagy a BASE_EXPRESSION paraméter mondja meg.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>What is not higher than this is left out: the robot drives over it. Stairs and ramps stay. Give the lower and the upper height together, or neither.</source>
            <translation>Ami ennél nem magasabb, kimarad: a robot áthajt rajta. Lépcsők és rámpák maradnak. Az alsó és felső magasságot együtt adja meg, vagy egyiket se.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>binary: the text compressed</source>
            <translation>bináris: a szöveg tömörítve</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>compact: binary in columns</source>
            <translation>tömör: bináris oszlopokban</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text</source>
            <translation>szöveg</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>text: lines that people and scripts read. binary: that text compressed, with a check sum. compact: the same map in columns of centimetres, also with a check sum (codec 2).</source>
            <translation>text: sorok, amelyeket emberek és szkriptek olvasnak. binary: ez a szöveg tömörítve, ellenőrző összeggel. compact: ugyanaz a térkép centiméterek oszlopaiban, szintén ellenőrző összeggel (2. kodek).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{before} became {after}</source>
            <translation>előtte: {before}; utána: {after}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{name} is {value:g}: give a number of metres of 0 or more.</source>
            <translation>{name} értéke {value:g}: adjon meg 0 vagy több métert.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/export_parameters.py" />
            <source>{other} is given and {missing} is not: give both heights in metres, or none.</source>
            <translation>{other} meg van adva, {missing} nincs: adja meg mindkét magasságot méterben, vagy egyiket se.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>GeoJSON needs longitudes and latitudes, and the map's place is not known: give SITE_CRS, ORIGIN and ROTATION, or choose geopackage, which keeps the site's metres.</source>
            <translation>A GeoJSON-hoz hosszúság és szélesség kell, és a térkép helye nem ismert: adja meg a SITE_CRS, ORIGIN és ROTATION értékét, vagy válassza a geopackage-et, amely a telephely métereit megtartja.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>ORIGIN {origin} or ROTATION {rotation} is not finite: give numbers.</source>
            <translation>ORIGIN {origin} vagy ROTATION {rotation} nem véges: adjon meg számokat.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Origin of the site frame in it (default: as the map says, else 0,0)</source>
            <translation>A telephelyi keret kezdőpontja benne (alapértelmezés: ahogy a térkép mondja, különben 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot map, text or binary</source>
            <translation>Robottérkép, szöveg vagy bináris</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Robot maps (*.txt *.map *.rmap *.bin);;All files (*)</source>
            <translation>Robottérképek (*.txt *.map *.rmap *.bin);;Minden fájl (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Rotation of the site frame, counter-clockwise [degrees] (default: as the map says, else 0)</source>
            <translation>A telephelyi keret elforgatása, az óramutató járásával ellentétesen [fok] (alapértelmezés: ahogy a térkép mondja, különben 0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>Site CRS (default: as the map says)</source>
            <translation>A telephely vetülete (alapértelmezés: ahogy a térkép mondja)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} has {size} bytes, and a robot map at most {largest_text}: choose a map.</source>
            <translation>A(z) {path} fájl {size} bájtos, egy robottérkép legfeljebb {largest_text}: válasszon térképet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The file {path} is no robot map: it is neither UTF-8 (byte {start}) nor in the binary format, which begins with {decode}. Choose another file.</source>
            <translation>A(z) {path} fájl nem robottérkép: se nem UTF-8 ({start}. bájt), se nem az a bináris formátum, amely így kezdődik: {decode}. Válasszon másik fájlt.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The leading line '%{key} {meta}' of the map should hold {wanted}: correct it there, or give {parameter}.</source>
            <translation>A térkép '%{key} {meta}' bevezető sorában ennek kell állnia: {wanted}. Javítsa ki ott, vagy adja meg: {parameter}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's place is not known, because {why}: its layers are in local metres. Give SITE_CRS, ORIGIN and ROTATION to place it.</source>
            <translation>A térkép helye nem ismert, mert {why}: rétegei helyi méterben vannak. A helyéhez adja meg: SITE_CRS, ORIGIN és ROTATION.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The map's positions cannot be transformed from {crs} to longitudes and latitudes ({error}): check the map's lines crs, origin and rotation.</source>
            <translation>A térkép helyzetei nem számíthatók át innen: {crs}, hosszúságra és szélességre ({error}): ellenőrizze a térkép crs, origin és rotation sorát.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {error}</source>
            <translation>A(z) {path} robottérkép nem olvasható: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>The robot map {path} cannot be read: {reason}. Check its rights.</source>
            <translation>A(z) {path} robottérkép nem olvasható: {reason}. Ellenőrizze a jogait.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>There is no file {file}: choose a robot map (MAP).</source>
            <translation>Nincs ilyen fájl: {file}. Válasszon egy robottérképet (MAP).</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>it names no CRS</source>
            <translation>nem nevez meg vetületet</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>the CRS {stated!r} that the map names is not known to QGIS</source>
            <translation>a térkép által megnevezett {stated!r} vetületet a QGIS nem ismeri</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/map_files.py" />
            <source>two numbers 'x,y'</source>
            <translation>két szám, 'x,y'</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Layer {sourcename}, feature {id}</source>
            <translation>{sourcename} réteg, {id}. elem</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>Qt cannot draw the picture of this map: choose svg and open that in a browser.</source>
            <translation>A Qt nem tudja megrajzolni ennek a térképnek a képét: válassza az svg-t, és nyissa meg böngészőben.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>SPEED {text!r} is no expression ({reason}): write a field's name or a number.</source>
            <translation>SPEED {text!r} nem kifejezés ({reason}): írjon mezőnevet vagy számot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>The layer {name} of the GeoPackage cannot be written: {error}.</source>
            <translation>A GeoPackage {name} rétege nem írható: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/navigation_files.py" />
            <source>has no speed above 0 m/s, so it sets no limit; it is left out</source>
            <translation>nincs 0 m/s feletti sebessége, így nem korlátoz; kimarad</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>A layer cannot be written ({reason}): choose another place or format for it, and check the free space.</source>
            <translation>Egy réteg nem írható ki ({reason}): válasszon neki másik helyet vagy formátumot, és ellenőrizze a szabad helyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>it is there and is no file</source>
            <translation>már létezik, és nem fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>no reason is given</source>
            <translation>nincs megadva ok</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>the folder {folder} may not be written to</source>
            <translation>a(z) {folder} mappába nem szabad írni</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>there is no folder {folder}</source>
            <translation>nincs {folder} mappa</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{path} is a folder, where a file is to be written: choose another OUTPUT.</source>
            <translation>{path} egy mappa, ahová fájl kerülne: válasszon másik OUTPUT-ot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {folder}: {reason}. Choose a folder that may be written to, and check the free space.</source>
            <translation>{what} nem írható ide: {folder}: {reason}. Válasszon írható mappát, és ellenőrizze a szabad helyet.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/outputs.py" />
            <source>{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists, may be written to, and has space.</source>
            <translation>{what} nem írható ide: {target}: {reason}. Válasszon fájlt olyan mappában, amely létezik, írható, és van benne hely.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Both CENTER and EXTENT are given: give one of them, the window cannot be both.</source>
            <translation>CENTER és EXTENT is meg van adva: adja meg az egyiket, az ablak nem lehet mindkettő.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Centre of the window (or choose an extent)</source>
            <translation>Az ablak közepe (vagy válasszon kiterjedést)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Extent (instead of centre, width and height)</source>
            <translation>Kiterjedés (közép, szélesség és magasság helyett)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Height of the window, along y [m]</source>
            <translation>Az ablak magassága y mentén [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Layers without a CRS are in metres of the site</source>
            <translation>A vetület nélküli rétegek telephelyi méterben vannak</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile ({kinds});;All files (*)</source>
            <translation>Térképprofil ({kinds});;Minden fájl (*)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Map profile: what the layers are, by their names (default: as each layer keeps it)</source>
            <translation>Térképprofil: mik a rétegek a nevük szerint (alapértelmezés: ahogy az egyes rétegek tárolják)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH and HEIGHT in metres, or an extent.</source>
            <translation>Sem CENTER, sem EXTENT nincs megadva: adja meg az ablak közepét a WIDTH és HEIGHT méterben megadott értékével, vagy egy kiterjedést.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Origin of the site frame (default: as the project has it, else 0,0)</source>
            <translation>A telephelyi keret kezdőpontja (alapértelmezés: a projekté, különben 0,0)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>ROTATION {degrees} is not finite: give a number.</source>
            <translation>ROTATION {degrees} nem véges: adjon meg számot.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Rotation of the site frame, counter-clockwise from the CRS's x axis [degrees]</source>
            <translation>A telephelyi keret elforgatása, a vetület x tengelyétől pozitív irányban [fok]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>SITE_CRS {crs} is no CRS that QGIS knows: write a code such as EPSG:32633.</source>
            <translation>SITE_CRS {crs} nem a QGIS által ismert vetület: írjon olyan kódot, mint EPSG:32633.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Site CRS, in metres (default: the project's, else the layers')</source>
            <translation>A telephely vetülete méterben (alapértelmezés: a projekté, különben a rétegeké)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>The layer {layer} is no vector layer: take its role away.</source>
            <translation>A(z) {layer} réteg nem vektorréteg: vegye el a szerepét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>Width of the window, along x [m]</source>
            <translation>Az ablak szélessége x mentén [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {extent} is no extent: write 'xmin,xmax,ymin,ymax'.</source>
            <translation>{name} {extent} nem kiterjedés: írja így: 'xmin,xmax,ymin,ymax'.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} has no place in the CRS {crs}: give finite numbers, x or longitude first, and the CRS that they are in.</source>
            <translation>{name} {value} helye nem létezik a(z) {crs} vetületben: adjon meg véges számokat, elöl az x-et vagy a hosszúságot, és azt a vetületet, amelyben értendők.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{name} {value} is in the CRS {own}, which has no known relation to the CRS {crs}: give it in that one.</source>
            <translation>{name} {value} vetülete {own}, amelynek nincs ismert kapcsolata ezzel: {crs}. Adja meg abban.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/parameters.py" />
            <source>{side} is {length}: give a finite number of metres.</source>
            <translation>{side} értéke {length}: adjon meg véges számú métert.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>The placed cones have no field {missing}: give a layer of a GeoPackage, or the CSV, that 'robot-bridge placements export' wrote.</source>
            <translation>A kihelyezett bójáknak nincs ilyen mezőjük: {missing}; adjon meg egy GeoPackage-réteget vagy a CSV-t, amelyet a 'robot-bridge placements export' írt.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>There are no placed cones to report on. Check the filter of the layer, and the options of 'robot-bridge placements export'.</source>
            <translation>Nincsenek kihelyezett bóják, amelyekről jelenteni lehetne. Ellenőrizze a réteg szűrőjét és a 'robot-bridge placements export' beállításait.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>cones</source>
            <translation>bóják</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>deviation in cm</source>
            <translation>eltérés cm-ben</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>last bar: up to {metres:.2f} m</source>
            <translation>utolsó oszlop: legfeljebb {metres:.2f} m</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/placed_cones.py" />
            <source>tolerance {cm:.4g} cm</source>
            <translation>tűrés {cm:.4g} cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is lost without a message for [s]</source>
            <translation>A robot elveszett, ha ennyi ideje nincs üzenete [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A robot is stale without a message for [s]</source>
            <translation>A robot elavult, ha ennyi ideje nincs üzenete [s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>A target is reached within [m]</source>
            <translation>A cél elérve ezen belül [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Database of the published site (PostGIS)</source>
            <translation>A telephely adatbázisa (PostGIS)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Folder of the published site</source>
            <translation>A közzétett telephely mappája</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Height where none is known [m]</source>
            <translation>Magasság, ahol nem ismert [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>It is not said where to publish: give FOLDER, a folder, or DATABASE, a PostgreSQL connection of QGIS's.</source>
            <translation>Nincs megmondva, hová tegyük közzé: adja meg a FOLDER mappát, vagy a DATABASE-t, a QGIS egy PostgreSQL-kapcsolatát.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Keepout layers (default: the project's with that role)</source>
            <translation>Tiltott területek rétegei (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Obstacle layers, stairs, ramps and furniture (default: the project's with such a role)</source>
            <translation>Akadály-, lépcső-, rámpa- és berendezésrétegek (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Replace the publication of another site</source>
            <translation>Másik telephely közzétételének felülírása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road centreline layers (default: the project's with that role)</source>
            <translation>Úttengelyrétegek (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Road surface layers (default: the project's with that role)</source>
            <translation>Útfelület-rétegek (alapértelmezés: a projekt ilyen szerepű rétegei)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>SITE_ID is empty and the project has no variable {site_variable}: give the site an id of letters, digits, '_', '.' and '-', such as north_yard.</source>
            <translation>SITE_ID üres, és a projektnek nincs {site_variable} változója: adjon a telephelynek betűkből, számjegyekből és '_', '.', '-' jelekből álló azonosítót, például north_yard.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site id (default: the project's)</source>
            <translation>A telephely azonosítója (alapértelmezés: a projekté)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Site name (default: the project's title)</source>
            <translation>A telephely neve (alapértelmezés: a projekt címe)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS is not known, and</source>
            <translation>A telephely vetülete nem ismert, és</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>The site's CRS, {crs_name},</source>
            <translation>A telephely vetületének ({crs_name})</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>There is nothing to publish: no layer is given and no layer of the project has a role. Give roles (Fleet Supervisor &gt; Layer roles), a PROFILE, or layers.</source>
            <translation>Nincs mit közzétenni: nincs megadva réteg, és a projekt egyik rétegének sincs szerepe. Adjon szerepeket (Fleet Supervisor &gt; Rétegszerepek), egy PROFILE-t, vagy rétegeket.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Where robots may be sent (default: all that is published)</source>
            <translation>Hová küldhetők robotok (alapértelmezés: minden, ami közzé van téve)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>Width of a road where none is known [m]</source>
            <translation>Az út szélessége, ahol nem ismert [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{named} has no code that a gateway knows it by: choose SITE_CRS such as EPSG:32633. Layers in local metres can be published with ORIGIN and LOCAL=true.</source>
            <translation>{named} nincs kódja, amelyről egy átjáró felismerné: válasszon SITE_CRS-t, például EPSG:32633. Helyi méterben lévő rétegek az ORIGIN értékével és LOCAL=true-val tehetők közzé.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{name} is {value}: give a number of metres above 0.</source>
            <translation>{name} értéke {value}: adjon meg 0-nál több métert.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{place} = {text} is no number: correct it there.</source>
            <translation>{place} = {text} nem szám: javítsa ki ott.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/publication_parameters.py" />
            <source>{title} (default: as published, at first {default:g})</source>
            <translation>{title} (alapértelmezés: ahogy közzétették, először {default:g})</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>E and N in metres of {crs}; {mark} beyond the tolerance of {tolerance:g} cm</source>
            <translation>K és É méterben, {crs}; {mark} a {tolerance:g} cm-es tűrésen túl</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Mean {mean}, RMS {rms}, 95 % within {p95}, largest {most}.</source>
            <translation>Átlag {mean}, négyzetes közép {rms}, 95 % ezen belül: {p95}, legnagyobb {most}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Off cm</source>
            <translation>Elt. cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Placed (UTC)</source>
            <translation>Kihelyezve (UTC)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned E</source>
            <translation>Tervezett K</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Planned N</source>
            <translation>Tervezett É</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>QGIS cannot make the report (layout export {number}): check the free space, and the background layers by leaving them out.</source>
            <translation>A QGIS nem tudja elkészíteni a jelentést (elrendezés exportálása: {number}): ellenőrizze a szabad helyet, és a háttérrétegeket elhagyásukkal.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>Robots: {names}</source>
            <translation>Robotok: {names}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>The report</source>
            <translation>A jelentés</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{first} to {last} UTC</source>
            <translation>{first} – {last} UTC</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{time} UTC</source>
            <translation>{time} UTC</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>{within} of %n cones ({share:.0f} %) stand within {tolerance:g} cm of their plan.</source>
            <translation>
                <numerusform>%n bójából {within} ({share:.0f} %) áll {tolerance:g} cm-en belül a tervhez képest.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation</source>
            <translation>× tervezett   ● kihelyezett (piros: a tűrésen túl)   narancs: eltérés</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>× planned   ● placed (red: beyond the tolerance)   orange: deviation, {factor} times as long</source>
            <translation>× tervezett   ● kihelyezett (piros: a tűrésen túl)   narancs: eltérés, {factor}-szoros hosszban</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>ΔE cm</source>
            <translation>ΔK cm</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/report_layout.py" />
            <source>ΔN cm</source>
            <translation>ΔÉ cm</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>%n edges lead through areas to be avoided, and are closed</source>
            <translation>
                <numerusform>%n él elkerülendő területen vezet át, és le van zárva</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Areas that must not be driven through</source>
            <translation>Területek, amelyeken nem szabad áthajtani</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>CRS in metres (default: the layer's, or the project's)</source>
            <translation>Méteres vetület (alapértelmezés: a rétegé vagy a projekté)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Direction: yes along the line, -1 against it, no both (default: a field oneway, ...)</source>
            <translation>Irány: yes a vonal mentén, -1 vele szemben, no mindkettő (alapértelmezés: egy oneway, ... mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Ends this near to a road were meant to meet it [m]</source>
            <translation>Ilyen közeli végek az úthoz tartoznak [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Farthest place from a road [m]</source>
            <translation>Legnagyobb távolság úttól [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}, feature {id}: {note}</source>
            <translation>{name} réteg, {id}. elem: {note}</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Layer {name}: the width of %n roads is not known; {width:g} m is used</source>
            <translation>
                <numerusform>{name} réteg: %n út szélessége nem ismert; {width:g} m lesz használva</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Level of each road, 0 on the ground (default: fields level, layer, bridge, tunnel)</source>
            <translation>Az egyes utak szintje, 0 a talajon (alapértelmezés: level, layer, bridge, tunnel mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>No road has the surface {surfaces}: the roads have {there}.</source>
            <translation>Egyik útnak sincs {surfaces} felülete: az utaké ez: {there}.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Points of the path at most this far apart [m]</source>
            <translation>A pálya pontjai legfeljebb ilyen távol egymástól [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS {roads} cannot be opened: check the file and the layer's name.</source>
            <translation>ROADS {roads} nem nyitható meg: ellenőrizze a fájlt és a réteg nevét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: no feature of the layer {name} is a road: each has to be a line with a length that the layer's filter keeps. {first}</source>
            <translation>ROADS: a(z) {name} réteg egyik eleme sem út: mindegyiknek hosszal rendelkező vonalnak kell lennie, amelyet a réteg szűrője megtart. {first}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>ROADS: the layer {name} has no features: choose the layer of the road centrelines.</source>
            <translation>ROADS: a(z) {name} rétegnek nincsenek elemei: válassza az úttengelyek rétegét.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repair: close gaps, cut overshoots, leave out what is drawn twice</source>
            <translation>Javítás: hézagok bezárása, túlnyúlások levágása, kétszer rajzoltak kihagyása</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Repaired: {kind} of feature {feature} at {where}: {text}</source>
            <translation>Javítva: {kind}, {feature}. elem, itt: {where}: {text}</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Roads at least this wide, and as wide as the robot [m]</source>
            <translation>Legalább ilyen és a robotnál nem keskenyebb utak [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on each road [m/s] (default: a field speed_ms, or maxspeed in km/h)</source>
            <translation>Sebesség az egyes utakon [m/s] (alapértelmezés: egy speed_ms mező, vagy maxspeed km/h-ban)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Speed on roads of which it is not known [m/s]</source>
            <translation>Sebesség az ismeretlen sebességű utakon [m/s]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surface of each road (default: the layer's role, else a field surface)</source>
            <translation>Az egyes utak felülete (alapértelmezés: a réteg szerepe, különben egy surface mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Surfaces that may be used (default: all)</source>
            <translation>Használható felületek (alapértelmezés: mind)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>The filter of its role keeps none of them.</source>
            <translation>A szerepének szűrője egyiket sem tartja meg.</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Turning radius of the robot [m]</source>
            <translation>A robot fordulási sugara [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Whether each road is closed (default: a field closed)</source>
            <translation>Le van-e zárva az egyes utak (alapértelmezés: egy closed mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of each road [m] (default: the layer's role, else a field width_m or width)</source>
            <translation>Az egyes utak szélessége [m] (alapértelmezés: a réteg szerepe, különben egy width_m vagy width mező)</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of roads of which it is not known [m]</source>
            <translation>Az ismeretlen szélességű utak szélessége [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/processing/common/road_sources.py" />
            <source>Width of the robot [m]</source>
            <translation>A robot szélessége [m]</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Only the first {count} positions were fetched. Choose less time, or fewer robots.</source>
            <translation>Csak az első {count} helyzet lett lekérve. Válasszon rövidebb időt vagy kevesebb robotot.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Putting positions in order</source>
            <translation>Helyzetek rendezése</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>Stopped: the rest of the time was not fetched.</source>
            <translation>Leállítva: a többi idő nem lett lekérve.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The gateway's answer cannot be used: {error}.</source>
            <translation>Az átjáró válasza nem használható: {error}.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>The rest of the time was not fetched: {error}</source>
            <translation>A többi idő nem lett lekérve: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>What came could not be put in order.</source>
            <translation>Ami megérkezett, azt nem lehetett sorba rendezni.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/history.py" />
            <source>{robot}: {command} · {state} by {by}</source>
            <translation>{robot}: {command} · {state}, {by}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source> · NOT ALL</source>
            <translation> · NEM MIND</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Choose a time and press Load.</source>
            <translation>Válasszon időt, és nyomja meg a Betöltés gombot.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>How much faster than it was</source>
            <translation>Hányszor gyorsabban, mint történt</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading …</source>
            <translation>Betöltés …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Loading … {positions}, up to {moment}</source>
            <translation>Betöltés … {positions}, eddig: {moment}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No positions are stored of that time.</source>
            <translation>Abból az időből nincsenek tárolt helyzetek.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>No robot is selected to be replayed. Select one, or replay all.</source>
            <translation>Nincs visszajátszandó kijelölt robot. Jelöljön ki egyet, vagy játssza vissza mindet.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play what robots did, on a map beside the live one</source>
            <translation>Lejátssza, mit tettek a robotok, az élő térkép mellett egy másikon</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Play, or hold (Space)</source>
            <translation>Lejátszás vagy megállítás (Szóköz)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY · {status}</source>
            <translation>VISSZAJÁTSZÁS · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>REPLAY, not live · {moment} · {status}</source>
            <translation>VISSZAJÁTSZÁS, nem élő · {moment} · {status}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>Replay</source>
            <translation>Visszajátszás</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay was not loaded: {error}</source>
            <translation>A visszajátszás nem töltődött be: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>The replay's time ends before it begins. Correct one of the two.</source>
            <translation>A visszajátszás ideje véget ér, mielőtt elkezdődne. Javítsa ki a kettő egyikét.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>There is nothing to replay yet. Connect to a gateway first.</source>
            <translation>Még nincs mit visszajátszani. Előbb kapcsolódjon egy átjáróhoz.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_dock.py" />
            <source>positions: {positions}, robots: {robots}</source>
            <translation>helyzetek: {positions}, robotok: {robots}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Drawing what robots drove</source>
            <translation>A robotok útjának megrajzolása</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Not all trajectories are drawn: {error}</source>
            <translation>Nincs minden trajektória megrajzolva: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>The trajectories are not drawn: they could not be made into lines.</source>
            <translation>A trajektóriák nincsenek megrajzolva: nem lehetett vonalakká alakítani őket.</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/replay_map.py" />
            <source>Trajectories (replay)</source>
            <translation>Trajektóriák (visszajátszás)</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From</source>
            <translation>Ettől</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>From when on</source>
            <translation>Mikortól</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load</source>
            <translation>Betöltés</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Load what the selected robots did, not what all did</source>
            <translation>A kijelölt robotok mozgását tölti be, nem mindegyikét</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Selected only</source>
            <translation>Csak a kijelöltek</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>To</source>
            <translation>Eddig</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>Until when</source>
            <translation>Meddig</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>from … to …</source>
            <translation>ettől … eddig …</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 15 minutes</source>
            <translation>az utolsó 15 perc</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 5 minutes</source>
            <translation>az utolsó 5 perc</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last 8 hours</source>
            <translation>az utolsó 8 óra</translation>
        </message>
        <message>
            <location filename="../../plugin/replay/time_controls.py" />
            <source>the last hour</source>
            <translation>az utolsó óra</translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections from {file}.</source>
            <translation>
                <numerusform>%n kapcsolat innen: {file}.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>%n connections in {file}, without tokens.</source>
            <translation>
                <numerusform>%n kapcsolat itt: {file}, tokenek nélkül.</numerusform>
            </translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Authentication</source>
            <translation>&amp;Hitelesítés</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Edit…</source>
            <translation>&amp;Szerkesztés…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Import…</source>
            <translation>&amp;Importálás…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;New…</source>
            <translation>Ú&amp;j…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Operator</source>
            <translation>&amp;Kezelő</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Remove</source>
            <translation>&amp;Eltávolítás</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Test</source>
            <translation>&amp;Próba</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>&amp;Token</source>
            <translation>&amp;Token</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>CA &amp;file</source>
            <translation>CA-&amp;fájl</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting to {name} …</source>
            <translation>Kapcsolódás ehhez: {name} …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connecting …</source>
            <translation>Kapcsolódás …</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections (*.json)</source>
            <translation>Kapcsolatok (*.json)</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Connections to gateways</source>
            <translation>Kapcsolatok az átjárókhoz</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>E&amp;xport…</source>
            <translation>E&amp;xportálás…</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Edit connection</source>
            <translation>Kapcsolat szerkesztése</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Export connections</source>
            <translation>Kapcsolatok exportálása</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Gateway</source>
            <translation>Átjáró</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Import connections</source>
            <translation>Kapcsolatok importálása</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Name</source>
            <translation>Név</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>New connection</source>
            <translation>Új kapcsolat</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Press New… for a gateway, or Import… for those that another computer has exported.</source>
            <translation>Az Új… gombbal egy átjárót vesz fel, az Importálás… gombbal azokat, amelyeket egy másik számítógép mentett ki.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Removed: {names}. Tokens stay in QGIS's authentication.</source>
            <translation>Eltávolítva: {names}. A tokenek a QGIS hitelesítésében maradnak.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>Replaced: {replaced}.</source>
            <translation>Lecserélve: {replaced}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>T&amp;est</source>
            <translation>P&amp;róba</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>There is a connection {name} already. Give this one another name.</source>
            <translation>Már van {name} nevű kapcsolat. Adjon másik nevet ennek.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>connection test</source>
            <translation>kapcsolati próba</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>kept by QGIS, encrypted; or choose one below</source>
            <translation>a QGIS őrzi, titkosítva; vagy válasszon lent</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>such as the site's name</source>
            <translation>például a telephely neve</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>who you are, in every log</source>
            <translation>kicsoda Ön, minden naplóban</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{file} cannot be written: {error}</source>
            <translation>{file} nem írható: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers, as {who}.</source>
            <translation>{site} ({crs}) válaszol, mint {who}.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/connections_widget.py" />
            <source>{site} ({crs}) answers.</source>
            <translation>{site} ({crs}) válaszol.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>Choose a file that Export wrote.</source>
            <translation>Válasszon az Exportálás által írt fájlt.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not give the token that it keeps: its master password was not given. Press Connect and enter it, or enter the token under Access.</source>
            <translation>A QGIS nem adta ki az őrzött tokent: nem adták meg a mesterjelszavát. Nyomja meg a Kapcsolódás gombot és adja meg, vagy írja be a tokent a Hozzáférés alatt.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>QGIS did not keep the token: its master password was not given. The token is used now and has to be entered again next time.</source>
            <translation>A QGIS nem őrizte meg a tokent: nem adták meg a mesterjelszavát. A token most érvényes, de legközelebb újra meg kell adni.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} is of the method {method}, which gateways do not know. Choose one of the method {wanted} with the token as its password.</source>
            <translation>A(z) {config} hitelesítés {method} módszerű, amelyet az átjárók nem ismernek. Válasszon {wanted} módszerűt, jelszóként a tokennel.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The authentication {config} that the connection names is not in this QGIS. Edit the connection and choose another, or enter the token.</source>
            <translation>A kapcsolatban megnevezett {config} hitelesítés nincs ebben a QGIS-ben. Szerkessze a kapcsolatot és válasszon másikat, vagy írja be a tokent.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>The connection has no name. Give it one, such as the site's.</source>
            <translation>A kapcsolatnak nincs neve. Adjon neki egyet, például a telephelyét.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>This QGIS keeps no authentication (its options say why, under Authentication): enter the token under Access.</source>
            <translation>Ez a QGIS nem őriz hitelesítést (hogy miért, a beállításai mondják meg a Hitelesítés lapon): írja be a tokent a Hozzáférés alatt.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} has no list named connections. {choose}</source>
            <translation>{source} nem tartalmaz connections nevű listát. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} holds no connections to gateways. {choose}</source>
            <translation>{source} nem tartalmaz átjárókhoz vezető kapcsolatokat. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is not JSON: {error}. {choose}</source>
            <translation>{source} nem JSON: {error}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source} is of version {found}; this plugin reads version {version}. Update the plugin.</source>
            <translation>{source} verziója {found}; ez a modul a {version}. verziót olvassa. Frissítse a modult.</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number} is not a set of texts named {keys}. {choose}</source>
            <translation>{source}: a(z) {number}. kapcsolat nem ilyen nevű szövegekből áll: {keys}. {choose}</translation>
        </message>
        <message>
            <location filename="../../plugin/settings/profile.py" />
            <source>{source}: connection {number}: {error}</source>
            <translation>{source}: {number}. kapcsolat: {error}</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet ended: {why}. Start it again; if that fails, see what {program} says by hand.</source>
            <translation>A gyakorlóflotta véget ért: {why}. Indítsa újra; ha nem sikerül, nézze meg, mit mond a {program} kézzel indítva.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice fleet needs robot-bridge, which is not on this computer. In a terminal, in the project's folder: python3 -m venv gateway, then gateway/bin/pip install . and put gateway/bin on PATH; or make setup. Then restart QGIS. The tour can be read without it.</source>
            <translation>A gyakorlóflottához a robot-bridge kell, amely nincs ezen a számítógépen. Terminálban, a projekt mappájában: python3 -m venv gateway, majd gateway/bin/pip install . és a gateway/bin kerüljön a PATH-ra; vagy make setup. Azután indítsa újra a QGIS-t. A bemutató enélkül is olvasható.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>The practice robot {robot} does not run: {why}. Close the tour and start the practice fleet again; if that fails, see what {program} says by hand.</source>
            <translation>A(z) {robot} gyakorlórobot nem fut: {why}. Zárja be a bemutatót, és indítsa újra a gyakorlóflottát; ha nem sikerül, nézze meg, mit mond a {program} kézzel indítva.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/practice_fleet.py" />
            <source>it ended with code {code}</source>
            <translation>{code} kóddal ért véget</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Back</source>
            <translation>&amp;Vissza</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Finish</source>
            <translation>Be&amp;fejezés</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>&amp;Next</source>
            <translation>&amp;Tovább</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A five-minute tour shows how it works.</source>
            <translation>Egy ötperces bemutató megmutatja, hogyan működik.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>A site is an ordinary QGIS project: an orthophoto, roads, obstacles, each layer with a role. Open the sample site; QGIS asks first if your own project is not saved.</source>
            <translation>A telephely közönséges QGIS-projekt: ortofotó, utak, akadályok, minden rétegnek szerepe van. Nyissa meg a mintatelephelyet; a QGIS előbb kérdez, ha saját projektje nincs mentve.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Abort robot: the selected robots give up their task. ABORT ALL: every robot does. EMERGENCY STOP (F10): every robot stops now, and none can be sent anywhere until a supervisor clears it.</source>
            <translation>Robot megszakítása: a kijelölt robotok feladják feladatukat. MIND MEGSZAKÍTÁSA: mindegyik. VÉSZLEÁLLÍTÁS (F10): minden robot most megáll, és egyik sem küldhető sehová, amíg egy felügyelő fel nem oldja.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>An arrow shows where a robot heads, its colour and shape the state. Hold the mouse over one for its card; with Select robot a click selects, a rectangle selects several, a double click goes there.</source>
            <translation>Nyíl mutatja, merre néz a robot, színe és alakja az állapotát. Tartsa fölé az egeret a kártyájához; a Robot kijelölése eszközzel kattintás kijelöl, téglalap többet, dupla kattintás oda ugrik.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>C&amp;lose</source>
            <translation>&amp;Bezárás</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Click r1: it is selected on the map, too.</source>
            <translation>Kattintson az r1-re: a térképen is kijelölt lesz.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Closing it ends the practice fleet. What else the desk does is in the operator's guide, docs/operator.md; how real robots are connected in docs/integrator.md.</source>
            <translation>Bezárása véget vet a gyakorlóflottának. Mi mást tud a kezelőpult: a kezelői kézikönyvben, docs/operator.md; valódi robotok csatlakoztatása: docs/integrator.md.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Cone target, a click on the map, Enter: that sends the selected robot. Before that it is a draft, checked against the site; Esc takes it away, and nothing was sent.</source>
            <translation>Bójacél, kattintás a térképen, Enter: ez elküldi a kijelölt robotot. Előtte csak vázlat, a telephellyel összevetve; az Esc elveszi, és semmi sem ment el.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Each robot has a row: its state, its task, its battery, and how old its last message is. A robot that falls silent is stale, then lost; it stays on the map, marked.</source>
            <translation>Minden robotnak sora van: állapota, feladata, akkumulátora, és hogy milyen régi az utolsó üzenete. Az elhallgató robot elavult, majd elveszett; megjelölve a térképen marad.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Every command is here with each of its steps: queued, delivered, acknowledged, reached; or why it failed. A double click shows its place on the map.</source>
            <translation>Minden parancs itt van minden lépésével: sorban, kézbesítve, nyugtázva, elérve; vagy hogy miért nem sikerült. Dupla kattintás megmutatja a helyét a térképen.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Five minutes with a practice fleet</source>
            <translation>Öt perc egy gyakorlóflottával</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Here stand the gateway's address and your name, which every log shows. For a real fleet write them and press Connect. For the tour, start the practice fleet: it connects by itself.</source>
            <translation>Itt áll az átjáró címe és az Ön neve, amelyet minden napló mutat. Valódi flottához írja be őket, és nyomja meg a Kapcsolódás gombot. A bemutatóhoz indítsa el a gyakorlóflottát: magától kapcsolódik.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Open the sample site</source>
            <translation>A mintatelephely megnyitása</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Send a robot</source>
            <translation>Robot küldése</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the practice fleet</source>
            <translation>Gyakorlóflotta indítása</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Start the tour</source>
            <translation>Bemutató indítása</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Starting …</source>
            <translation>Indítás …</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>That was the tour</source>
            <translation>Ez volt a bemutató</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The desk is connected to another gateway. Disconnect first: the tour moves no real robots.</source>
            <translation>A kezelőpult másik átjáróhoz van kapcsolva. Előbb bontsa: a bemutató nem mozgat valódi robotokat.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The link</source>
            <translation>A kapcsolat</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The map</source>
            <translation>A térkép</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The practice fleet runs, and the desk is connected to it.</source>
            <translation>A gyakorlóflotta fut, és a kezelőpult hozzá van kapcsolva.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The robots</source>
            <translation>A robotok</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site is open.</source>
            <translation>A mintatelephely nyitva van.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The sample site was not opened: {path}.</source>
            <translation>A mintatelephely nem nyílt meg: {path}.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The site</source>
            <translation>A telephely</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>The tour needs no network: a gateway and three simulated robots run on this computer, and nothing real moves. Next and Back lead on, Esc closes. It is in the menu Plugins &gt; Fleet Supervisor &gt; Tour.</source>
            <translation>A bemutatóhoz nem kell hálózat: egy átjáró és három szimulált robot fut ezen a számítógépen, és semmi valódi nem mozog. A Tovább és a Vissza vezet, az Esc bezárja. A Modulok &gt; Fleet Supervisor &gt; Bemutató menüben van.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Tour</source>
            <translation>Bemutató</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: only practice robots stop. Then clear it in the red banner.</source>
            <translation>Próbálja ki: csak gyakorlórobotok állnak meg. Azután oldja fel a piros sávban.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>Try it: press Cone target, click on the road near r1, then Enter.</source>
            <translation>Próbálja ki: nyomja meg a Bójacél gombot, kattintson az útra r1 közelében, majd Enter.</translation>
        </message>
        <message>
            <location filename="../../plugin/tour/tour_panel.py" />
            <source>What became of it</source>
            <translation>Mi lett belőle</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Abort robot</source>
            <translation>Robot megszakítása</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Add to queue</source>
            <translation>Várólistára</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Clear emergency stop…</source>
            <translation>Vészleállítás feloldása…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Close a road for every robot by a click on it, or open a closed one again</source>
            <translation>Út lezárása minden robot elől egy kattintással, vagy egy lezárt megnyitása</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Cone target</source>
            <translation>Bójacél</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Connect to the gateway, or disconnect</source>
            <translation>Kapcsolódás az átjáróhoz, vagy bontás</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Continue</source>
            <translation>Folytatás</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Coordinates…</source>
            <translation>Koordináták…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw a route for the selected robot: click its points, right click ends drawing, drag points or lines to change it, Backspace takes the last one back, Enter or Send sends, Esc cancels</source>
            <translation>Útvonal rajzolása a kijelölt robotnak: kattintson a pontjaira, jobb kattintás befejezi a rajzolást, pontok vagy vonalak húzásával módosítsa, a Backspace visszaveszi az utolsót, az Enter vagy a Küldés elküldi, az Esc elveti</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Draw route</source>
            <translation>Útvonal rajzolása</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot gives up its task, at once and without a question</source>
            <translation>Minden robot feladja a feladatát, azonnal és kérdés nélkül</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every robot stops now, and none can be sent anywhere until a supervisor clears it ({one_key} or {other_key})</source>
            <translation>Minden robot most megáll, és egyik sem küldhető sehová, amíg egy felügyelő fel nem oldja ({one_key} vagy {other_key})</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot gives up its task at once</source>
            <translation>Minden kijelölt robot azonnal feladja a feladatát</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Every selected robot stands at once and keeps its task, until it is let go on with Continue</source>
            <translation>Minden kijelölt robot azonnal megáll, és megtartja a feladatát, amíg a Folytatás tovább nem engedi</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Fleet panel</source>
            <translation>Flottapanel</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Follow</source>
            <translation>Követés</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep all in view</source>
            <translation>Mind látszódjon</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep every robot in view</source>
            <translation>Minden robot látszódjon</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Keep the selected robots in view</source>
            <translation>A kijelölt robotok látszódjanak</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let a draft be sent in spite of what the checks found; asks why</source>
            <translation>A vázlat küldhető annak ellenére, amit az ellenőrzés talált; megkérdezi, miért</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let robots be sent again; takes a supervisor, and asks first</source>
            <translation>A robotok újra küldhetők; felügyelő kell hozzá, és előbb kérdez</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the route begin at its end; R over the map does so too</source>
            <translation>Az útvonal a végén kezdődjön; a térkép fölött az R is ezt teszi</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Let the selected robots that are paused go on with their tasks, from where they stand</source>
            <translation>A kijelölt, szüneteltetett robotok onnan folytatják a feladatukat, ahol állnak</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the change again that was taken back; Ctrl+Shift+Z over the map does so too</source>
            <translation>A visszavont változás megismétlése; a térkép fölött a Ctrl+Shift+Z is ezt teszi</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Make the draft of what is selected in the active layer: a point, a line, or many points</source>
            <translation>Vázlat az aktív réteg kijelöléséből: pont, vonal vagy sok pont</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Pause robot</source>
            <translation>Robot szüneteltetése</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Put what is drawn at the end of its robot's queue, instead of sending it</source>
            <translation>A rajz a robot várólistájának végére kerül elküldés helyett</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Redo</source>
            <translation>Újra</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Route along the roads for the selected robot: the way to the mouse is shown, a click takes it, right click ends drawing; Backspace takes the last leg back, Enter or Send sends, Esc cancels</source>
            <translation>Útvonal az utakon a kijelölt robotnak: az egérig vezető út látszik, kattintás elfogadja, jobb kattintás befejezi a rajzolást; a Backspace visszaveszi az utolsó szakaszt, az Enter vagy a Küldés elküldi, az Esc elveti</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Say how Route on roads is to lead: shortest or fastest, on which surfaces, off the roads of other robots</source>
            <translation>Megadja, hogyan vezessen az Útvonal utakon: a legrövidebb vagy a leggyorsabb legyen, mely felületeken, más robotok útjait elkerülve</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robot</source>
            <translation>Robot kijelölése</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Select robots on the map: click one or drag a rectangle, with Shift to add, with Ctrl to take away; double click goes there</source>
            <translation>Robotok kijelölése a térképen: kattintson egyre vagy húzzon téglalapot, Shift hozzáad, Ctrl elvesz; dupla kattintásra oda ugrik</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send map</source>
            <translation>Térkép küldése</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send the selected robots the map of the whole site now</source>
            <translation>Az egész telephely térképének küldése most a kijelölt robotoknak</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Send what is drawn on the map to its robot</source>
            <translation>A térképre rajzoltak elküldése a robotnak</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Set a cone target for the selected robot: click, then Enter or Send; Esc cancels</source>
            <translation>Bójacél a kijelölt robotnak: kattintás, majd Enter vagy Küldés; az Esc elveti</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Show or hide the fleet panel</source>
            <translation>A flottapanel mutatása vagy elrejtése</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Start position</source>
            <translation>Kiinduló helyzet</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take from layer</source>
            <translation>Rétegből</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take the last change of the draft back; Ctrl+Z over the map does so too</source>
            <translation>A vázlat utolsó változásának visszavonása; a térkép fölött a Ctrl+Z is ezt teszi</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Take what is drawn off the map; nothing is sent</source>
            <translation>A rajz levétele a térképről; semmi sem lesz elküldve</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Tell the selected robot where it stands: click, or drag to where it points; then Enter or Send</source>
            <translation>Megmondja a kijelölt robotnak, hol áll: kattintson, vagy húzza arra, amerre néz; majd Enter vagy Küldés</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Turn route round</source>
            <translation>Útvonal megfordítása</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Type or paste coordinates in any CRS in place of a click</source>
            <translation>Koordináták beírása vagy beillesztése bármely vetületben kattintás helyett</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Undo</source>
            <translation>Visszavonás</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>Ways on roads…</source>
            <translation>Útvonalak utakon…</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/actions.py" />
            <source>{key} is the key of the EMERGENCY STOP and does not perform {action}. Give that another key in Settings &gt; Keyboard Shortcuts.</source>
            <translation>A(z) {key} a VÉSZLEÁLLÍTÁS billentyűje, ezt nem hajtja végre: {action}. Adjon annak másik billentyűt itt: Beállítások &gt; Gyorsbillentyűk.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/language.py" />
            <source>{state}, last heard {age} ago over {link}</source>
            <translation>{state}, utolsó hír {age} óta, ezen: {link}</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/scheduling.py" />
            <source>a fault of the plugin: {error}. View &gt; Panels &gt; Log Messages says where: report it.</source>
            <translation>a bővítmény hibája: {error}. A Nézet &gt; Panelek &gt; Naplóüzenetek megmondja, hol: jelentse.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/tables.py" />
            <source>{file} was not written ({why}). Choose another folder, or close the file where it is open.</source>
            <translation>{file} nem lett kiírva ({why}). Válasszon másik mappát, vagy zárja be a fájlt, ahol nyitva van.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets is missing, which the connection to the gateway needs. Install the plugin from its release zip, which contains it, or run 'python3 -m pip install websockets' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>Hiányzik a websockets Python-csomag, amely az átjáróhoz való kapcsolódáshoz kell. Telepítse a modult a kiadott zipből, amely tartalmazza, vagy futtassa a QGIS Pythonjával: 'python3 -m pip install websockets', és indítsa újra a QGIS-t.</translation>
        </message>
        <message>
            <location filename="../../plugin/ui/vendored.py" />
            <source>The Python package websockets {version} in {path} is too old for the connection to the gateway. Install the plugin from its release zip, which contains a newer one, or run 'python3 -m pip install "websockets&gt;={oldest}"' with the Python that QGIS uses, and restart QGIS.</source>
            <translation>A websockets Python-csomag {version} verziója ({path}) túl régi az átjáróhoz való kapcsolódáshoz. Telepítse a modult a kiadott zipből, amely újabbat tartalmaz, vagy futtassa a QGIS Pythonjával: 'python3 -m pip install "websockets&gt;={oldest}"', és indítsa újra a QGIS-t.</translation>
        </message>
    </context>
</TS>
